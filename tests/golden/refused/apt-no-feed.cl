$$ line 7: a feed move without a feed; put FEDRAT first
UNITS/MM
LOADTL/1
SPINDL/RPM,9000,CLW
RAPID
GOTO/0,0,50
GOTO/5,0,50
FINI
