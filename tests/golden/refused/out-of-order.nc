; line 7: N10 comes after N20: lines are out of order; put them back or renumber them
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
N20 G1 X5 F100
N10 X6
M30
