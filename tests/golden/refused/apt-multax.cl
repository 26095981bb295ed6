$$ line 3: MULTAX/SLANTED is not understood; use ON or OFF
UNITS/MM
MULTAX/SLANTED
FINI
