; line 6: G86: this cycle is not understood; write the moves out
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G98 G86 X1 Y1 Z-3 R2 P0 F100
M30
