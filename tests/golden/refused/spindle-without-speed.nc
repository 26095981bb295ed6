; line 4: M3 without a spindle speed; give S
G21 G90 G54
T1 M6
M3
M30
