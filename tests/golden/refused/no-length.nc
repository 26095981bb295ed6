; line 4: a move in Z without the tool's length; put G43 H1 first
G21 G90 G54
T1 M6
G0 X0 Y0 Z50
M30
