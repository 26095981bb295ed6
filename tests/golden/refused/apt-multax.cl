$$ line 3: MULTAX/ON: tilted axes are not understood; use MULTAX/OFF
UNITS/MM
MULTAX/ON
FINI
