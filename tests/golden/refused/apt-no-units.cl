$$ line 4: a length before its unit is said; put UNITS/MM or UNITS/INCHES first
LOADTL/1
RAPID
GOTO/0,0,50
FINI
