$$ line 8: a tilted tool axis is not understood
UNITS/MM
LOADTL/1
SPINDL/RPM,9000,CLW
RAPID
GOTO/0,0,50
RAPID
GOTO/0,0,50,0.6,0,0.8
FINI
