"""`python -m trunnion_resources NAME` prints where a sample part lies."""

from __future__ import annotations

import sys

from trunnion_resources import sample

print(sample(sys.argv[1]))
