"""Channel drives: made from an operation on a wheel, what is costly once a setup."""

from __future__ import annotations

from dataclasses import replace

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.blank import Blank
from trunnion.model.feature import Recognition
from trunnion.model.operation import Operation, OperationPath
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.part.shape.exact import ExactFace
from trunnion.plan.channel.blank_depth import BlankDepth
from trunnion.plan.channel.cut_space import CutSpace
from trunnion.plan.channel.drive import ChannelDrive
from trunnion.plan.contract import DriveNeeds, OperationDrive, Scene
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.keys import SCALLOP, number, total_allowance
from trunnion.plan.impeller.wheel import (
    BLADE,
    EDGES,
    HUB,
    ROOT,
    SPLITTER,
    TIP,
    WALLS,
    Wheel,
    wheel_of,
)
from trunnion.progress import Progress
from trunnion.settings import digest


def rotor_setup(setup: Setup, rotor: Frame, blank: Blank) -> Setup:
    """Return a setup as seen in the rotor's frame, its clearance as far above blank and fixtures as the setup's own."""
    turned = replace(setup, frame=rotor)
    return replace(turned, clearance=turned.top(blank) + setup.clearance - setup.top(blank))


def channel_driven(
    operation: Operation, needs: DriveNeeds, scene: Scene, progress: Progress
) -> OperationDrive:
    """Return the channel drive of an operation: its faces of the first period, or where it has none, or those of a hub, all channels."""
    rotor = scene.recognition.frame
    setup = rotor_setup(scene.setup, rotor, scene.blank)
    skin = scene.once(
        ("rotor skin",),
        lambda: scene.context.skin(tolerance.CHORD, progress).moved(WORLD, rotor),
    )
    progress.check()
    wheel = scene.once(("wheel",), lambda: wheel_of(scene.recognition, skin))
    channels = scene.once(("channels",), lambda: wheel.channels(skin, progress))
    progress.check()
    around = scene.context.around(scene.setup, rotor, skin, progress)
    faces, tips, roots, named = _first_faces(operation, wheel, scene.recognition)
    low, high = scene.blank.box_in(rotor)
    blank = scene.blank
    before = _balls(scene) if named and not operation.faces else ()
    identity = digest(
        scene.context.part.digest,
        scene.context.part.solid,
        operation.feature,
        operation.kind,
        operation.faces,
        rotor,
        blank,
        setup.clearance,
        number(operation, SCALLOP),
        total_allowance(operation),
        scene.recognition.features,
        [laid.key for _, laid in before],
    )
    progress.check()
    surface = SurfaceDrive(
        feature=operation.feature,
        kind=operation.kind,
        faces=faces,
        exact=tuple(ExactFace(scene.context.part, tag, rotor) for tag in faces),
        skin=skin,
        frame=rotor,
        low=low,
        high=high,
        clearance=setup.clearance,
        allowance=total_allowance(operation),
        height=number(operation, SCALLOP),
        digest=identity,
        query_for=around,
    )
    progress.check()
    drive = ChannelDrive(
        surface=surface,
        channels=channels,
        in_channels=named,
        copies=wheel.copies,
        blank=blank,
        inward=scene.once(("blank depth",), lambda: BlankDepth.of(blank, rotor)),
        holds=around.holds,
        sharp=not any(f.with_role(*ROOT) for f in wheel.blades[: wheel.period]),
        fixed=bool(setup.fixtures or scene.fixtures),
        tips=tips,
        roots=roots,
        cut=tuple(
            CutSpace.of(laid.path, tool).moved(scene.setup.frame, rotor) for tool, laid in before
        ),
    )
    return OperationDrive.of(setup=setup, drive=drive, identity=(identity, scene.fixtures))


def _balls(scene: Scene) -> tuple[tuple[Tool, OperationPath], ...]:
    """Return the balls and tapered balls that have cut before, with their toolpaths."""
    return tuple(
        (tool, laid)
        for tool, laid in scene.laid
        if tool.form in ("ball", "taper") and tool.corner_radius == tool.radius
    )


def _first_faces(
    operation: Operation, wheel: Wheel, recognition: Recognition
) -> tuple[tuple[int, ...], tuple[int, ...], tuple[int, ...], bool]:
    """Return of an operation's faces those of the first period, the faces beyond their rims towards shroud and hub, and whether it goes
    through the channels: it roughs, or finishes the hub.

    Raises `Refused` for faces of no blade and no hub.
    """
    mine = set(operation.faces)
    hub = {t for f in recognition.of_kind(HUB) for t in f.tags}
    if not mine or mine <= hub:
        return (), (), (), True
    for kind in (BLADE, SPLITTER):
        for own, before, behind in (
            ((*WALLS, *EDGES), TIP, ROOT),
            (ROOT, (*WALLS, *EDGES), ()),
        ):
            faces = wheel.faces(own, kind, first=True)
            if mine & set(faces):
                roots = wheel.faces(behind, kind, first=True) if behind else tuple(sorted(hub))
                return (
                    tuple(t for t in faces if t in mine),
                    wheel.faces(before, kind, first=True),
                    roots or tuple(sorted(hub)),
                    False,
                )
    raise Refused(
        f"{operation.id}: its faces are no walls, root fillets or hub of the wheel; choose a strategy of the surface family"
    )
