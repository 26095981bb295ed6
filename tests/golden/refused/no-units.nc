; line 5: a move before its unit is said; put G21 or G20 first
G90 G54
T1 M6
G43 H1
G0 X0 Y0 Z50
M30
