"""The Debian package: `python -m installer.deb WHEEL`."""
