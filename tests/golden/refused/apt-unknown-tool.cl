$$ line 3: tool 2 is not in the tool list; it has 1, 7
UNITS/MM
LOADTL/2
FINI
