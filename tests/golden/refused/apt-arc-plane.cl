$$ line 8: an arc about another axis than Z is not understood
UNITS/MM
LOADTL/1
SPINDL/RPM,9000,CLW
RAPID
GOTO/0,0,50
FEDRAT/100,MMPM
CIRCLE/5,0,50,0,1,0,5
GOTO/10,0,50
FINI
