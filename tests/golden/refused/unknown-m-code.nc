; line 6: M62 is not understood; remove it or write what it does in known words
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
M62 P1
M30
