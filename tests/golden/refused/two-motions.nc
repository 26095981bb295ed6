; line 6: G0 and G1 can't stand in one line; keep one
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G0 G1 X1 F100
M30
