; line 2: G55 is not the work offset of setup S1, G54; use that
G21 G90 G55
M30
