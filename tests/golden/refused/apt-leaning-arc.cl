$$ line 10: an arc of a tool that leans is not understood; write lines
UNITS/MM
MULTAX/ON
LOADTL/1
SPINDL/RPM,9000,CLW
FEDRAT/100,MMPM
RAPID
GOTO/10,0,50,0.6,0,0.8
CIRCLE/0,0,50,0,0,1,10
GOTO/0,10,50,0.6,0,0.8
FINI
