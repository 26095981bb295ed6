; line 6: M4: it turns the cutter backwards; use M3
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
M4
M30
