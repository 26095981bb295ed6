; line 6: expressions are not understood; write the numbers themselves
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G1 X[1+2] F100
M30
