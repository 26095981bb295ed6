"""The AppImage, and the folder in it: `python -m installer.appimage WHEEL`."""
