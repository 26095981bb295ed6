; line 6: G41: cutter compensation changes the path at the machine; write the tool centre's path under G40
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G41 D1
M30
