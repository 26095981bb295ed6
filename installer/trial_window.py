"""Draws the window of an installed program with a recognised part, without a screen: `trunnion-python trial_window.py PART PICTURE`."""

import sys

from trunnion_gui.screenshots import opened, take

if __name__ == "__main__":
    with opened(sys.argv[1], until="recognize") as window:
        take(window, sys.argv[2])
