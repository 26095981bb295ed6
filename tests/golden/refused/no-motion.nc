; the program moves nothing: it holds no feed move or rapid
G21 G90 G54
M30
