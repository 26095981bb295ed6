; line 6: an arc with R and with I or J; keep one of them
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G2 X10 Y0 I5 R5 F100
M30
