; line 6: a comment's brackets don't match, or one comment stands inside another
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G1 (a (b) c) X5 F100
M30
