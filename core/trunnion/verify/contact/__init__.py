"""Does anything enter what it must not? Cutter, shank and holder against the finished part, along every block."""

from __future__ import annotations

from trunnion.verify.contact.grid import Grid as Grid
from trunnion.verify.contact.grid import grid_of as grid_of
from trunnion.verify.contact.strips import Contact as Contact
from trunnion.verify.contact.strips import PartContact as PartContact
from trunnion.verify.contact.strips import guide_points as guide_points
