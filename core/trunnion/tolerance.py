"""The one place for tolerances, named by what they mean. Lengths in mm, angles in radians unless the name says otherwise."""

from __future__ import annotations

import math

COINCIDENT = 1e-6
"""Two points closer than this are one point: ten times the modelling tolerance of the CAD kernel, far below a machine's resolution."""

SEW = 1e-2
"""Widest gap that is closed between trimmed surfaces that arrive unsewn; more is an open part."""

SLIVER = 2e-3
"""A face or loop narrower than this can't be told from the modeller's noise and is joined to its neighbour."""

PLANE_REGION = 1e-3
"""Chord error at which arcs are opened into chords while a plane region's topology is found; the exact arcs are put back after."""

AREA = 1e-4
"""mm2: a plane piece smaller than this is noise of the topology step."""

CHORD = 5e-3
"""Chord error of meshes that are only looked at."""

PICTURE = 0.05
"""Least chord error of meshes in a report's pictures: a third of a pixel of a part of 200 mm, drawn three times as fast as a finer one."""

PICTURE_SHARE = 1.0 / 4000.0
"""Chord error of these meshes as a share of the diagonal of the part's box, where that is more: a third of a pixel of any part."""

VIEW_SHARE = 1.0 / 10000.0
"""Chord error of meshes in the window as a share of the same diagonal, where that is more than `CHORD`: a pixel at seven times as large."""

MESH_ANGLE = 0.3
"""Turn from chord to chord (radians) of meshes that are only looked at; finer ones cost seconds (measured) and show nothing more."""

FITTED = 1e-4
"""How far an arc may be from the curve, or a plain surface from the free-form one, that it stands for."""

SECTION_STEP = 1e-5
"""A section plane that touches a vertex or holds a face is moved up by this: far below any tolerance of a part, ten times COINCIDENT."""

GOUGE = 0.02
"""Default limit of the verdict: how deep anything may enter the finished part."""

FINISH_GOUGE = 6e-3
"""How deep a planned finishing move may be found in the part it touches: chords of path and facets and the turning bound together."""

SKIN_CHORD = 5e-4
"""Chord error of the triangles that finishing cutters are dropped on: with that of the path an eighth of a scallop of 0.004 mm."""

HOLDER_CLEARANCE = 0.2
"""How far neck, shank and holder of a leaning tool are kept from part and fixtures: what a machine's five axes may add up to."""

FIXTURE_CLEARANCE = 1.0
"""How far planners keep all of a tool from fixtures, beside and over them: clamps are not placed as exactly as parts are."""

CONTACT_BOUND = 2e-3
"""How far the contact engine's figure may be from the truth with a fixed tool axis."""

TURNING_BOUND = 5e-3
"""The same with a tool axis that turns during a block."""

FACET_CHORD = 1.5e-3
"""Chord error of the triangles that stand for curved faces in the contact engine: with what they may be off in between it is still less
than what a fixed axis is judged to."""

STOCK_CHORD = 2e-3
"""How far a cutter's way through the stock may be from the spans it is cut in: ridges and steps stay below it."""

RAPID_DEPTH = 0.01
"""A rapid is in stock when it is deeper than this in it: below, it slides on a surface that was just cut."""

ANGLE = math.radians(0.05)
"""Two directions closer than this are parallel: CAD files carry directions to about 1e-7, exports through other systems to 1e-4."""

TANGENT = math.radians(0.5)
"""A dihedral angle closer than this to flat is smooth: rolling-ball fillets are approximated by their modellers."""

SMOOTH_JOIN = math.radians(10.0)
"""Faces whose normals differ by less where they meet run into each other: passes go on over such a join, and stop at a sharper one."""

JOINED_POINTS = 1e-5
"""Points of two faces' triangles on their common edge are one point: each face's own curve gives it to about a tenth of this."""

PARAMETRIC = 1e-9
"""Two numbers that were computed the same way and differ by less are equal."""

ARC_RADIUS = 1.27e-3
"""Largest difference of an arc's radius at its two ends that a control takes: LinuxCNC's CENTER_ARC_RADIUS_TOLERANCE_MM."""

WRITTEN = 5e-4
"""What rounding to the decimals of a program, in mm or inch, may move a point by."""

SHORT_MOVE = 1e-4
"""A move shorter than this is dropped: posts write four decimals, so it would be a block that goes nowhere."""

SHORT_ARC = 5e-3
"""An arc shorter than this goes out as a line: it leaves the arc by less than 1 um, and its rounded ends would no longer fit its radius."""

ON_REGION = 1e-3
"""A cutter location this far outside its region is still on its rim: offsets agree to 1 um."""

OFF_PLANE = 0.02
"""How far above or below a horizontal face a section is taken to see what stands on it: clear of the face, below the smallest blend."""
