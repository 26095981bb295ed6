; line 7: G18 with T1, a tool that rotates; arcs in the plane ZX are of turning, use G17
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G18
G0 X5
M30
