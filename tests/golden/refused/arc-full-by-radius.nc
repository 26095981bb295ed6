; line 6: an arc with R must end elsewhere than it starts; use I and J for a full circle
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G2 X0 Y0 R5 F100
M30
