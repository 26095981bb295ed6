; line 6: G18: arcs in the plane ZX are not understood; use G17
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G18
M30
