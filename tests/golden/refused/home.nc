; line 6: G28: the place of G28 is not known here; use G53 G0 Z0
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G28
M30
