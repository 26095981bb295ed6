; line 6: a feed move before it is known where the tool is; begin with a rapid to X, Y and Z
G21 G90 G54
T1 M6
S9000 M3
G43 H1
G1 X0 Y0 Z50 F100
M30
