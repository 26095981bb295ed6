; line 5: it is not known where the tool is; begin with a rapid to X, Y and Z
G21 G90 G54
T1 M6
G43 H1
G0 X0 Z50
M30
