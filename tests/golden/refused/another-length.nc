; line 4: H7 is the length of another tool than T1 in the spindle; use H1
G21 G90 G54
T1 M6
G43 H7
M30
