$$ line 2: setup S3 is not in the plan; it has S1
PPRINT/SETUP S3 WORK OFFSET G54
FINI
