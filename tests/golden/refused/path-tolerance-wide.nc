; line 6: G64 P0.1 rounds corners off by more than 0.02 mm; give a smaller P
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G64 P0.1
M30
