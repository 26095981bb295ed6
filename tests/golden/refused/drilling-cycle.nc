; line 6: G98: canned cycles are not understood; write the moves out
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G98 G81 X1 Y1 Z-3 R2 F100
M30
