; line 7: a feed move in inverse time (G93) needs an F word of its own
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G93 G1 X5 F10
X6
M30
