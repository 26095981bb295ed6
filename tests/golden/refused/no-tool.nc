; line 3: a move before a tool is in the spindle; put T and M6 first
G21 G90 G54
G0 X0 Y0 Z50
M30
