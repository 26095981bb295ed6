"""Installers of the program, made from its wheel: a Debian package, an AppImage, a recipe for Windows."""
