; line 6: of G53 only G53 G0 Z0, straight up to the top of the machine, is understood
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G53 G0 X0
M30
