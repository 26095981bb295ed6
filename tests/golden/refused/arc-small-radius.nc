; line 6: the radius R5 is too small to reach the arc's end, 14.1421 mm away
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G2 X10 Y10 R5 F100
M30
