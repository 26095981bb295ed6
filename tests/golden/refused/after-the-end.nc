; line 7: stands after the end of the program; remove it or the M30 before it
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
M30
G0 X5
