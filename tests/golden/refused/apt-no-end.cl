$$ the text has no FINI: is it complete?
UNITS/MM
LOADTL/1
SPINDL/RPM,9000,CLW
RAPID
GOTO/0,0,50
