; line 5: a move before its work offset is said; put G54 first
G21 G90
T1 M6
G43 H1
G0 X0 Y0 Z50
M30
