; line 6: G5.1 is not understood; remove it or write what it does in known words
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G5.1 X1
M30
