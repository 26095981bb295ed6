$$ line 7: 0,0, is not a list of numbers
UNITS/MM
LOADTL/1
SPINDL/RPM,9000,CLW
RAPID
GOTO/0,0,50
GOTO/0,0,$
