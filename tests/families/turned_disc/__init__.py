"""A family of a package of its own, for the tests: turned discs with a bevelled rim and a milled slot, from recognition to window."""
