"""What families of parts bring to the window, a module or package each; only these name families and their kinds of feature."""
