; line 3: T9 is not in the tool list; it has 1, 7
G21 G90 G54
T9 M6
M30
