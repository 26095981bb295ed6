; the program has no end (M30 or M2): is the text complete?
