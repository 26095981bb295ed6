$$ line 3: length 99 is not that of tool 1, 140.5 mm
UNITS/MM
LOADTL/1,LENGTH,99
FINI
