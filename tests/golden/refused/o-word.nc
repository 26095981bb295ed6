; line 6: subprograms and loops (O words) are not understood; write the motions out
G21 G90 G17 G40 G94 G54
T1 M6
S9000 M3
G0 G43 H1 X0 Y0 Z50
o100 sub
M30
