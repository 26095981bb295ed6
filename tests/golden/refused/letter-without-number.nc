; line 6: X is not understood; a word is a letter and a number
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
G1 X F100
M30
