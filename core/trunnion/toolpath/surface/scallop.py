"""Scallops and stepovers; planning asks the same when it chooses cutters (`plan.surface.scallop`)."""

from trunnion.plan.surface.scallop import HEIGHT_PER_RA as HEIGHT_PER_RA
from trunnion.plan.surface.scallop import height_of as height_of
from trunnion.plan.surface.scallop import radius_across as radius_across
from trunnion.plan.surface.scallop import roughness as roughness
from trunnion.plan.surface.scallop import scallop_on_plane as scallop_on_plane
from trunnion.plan.surface.scallop import stepover_on_curve as stepover_on_curve
from trunnion.plan.surface.scallop import stepover_on_plane as stepover_on_plane
