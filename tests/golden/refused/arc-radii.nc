; line 6: the arc starts at radius 5.0000 and ends at 11.1803 mm; check its end or its centre
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G2 X10 Y10 I5 J0 F100
M30
