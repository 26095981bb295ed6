; line 2: F and a change of units in one line: the feed's unit is not clear; write two lines
G21 F100
M30
