; line 6: I, J or R without an arc; put G2 or G3 first
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G1 X5 I2 F100
M30
