$$ line 6: the tool axis has the length 2.0000; it must be a unit vector
UNITS/MM
MULTAX/ON
LOADTL/1
RAPID
GOTO/0,0,50,0,0,2
FINI
