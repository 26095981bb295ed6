"""Tools, setups, programs and a whole session made by hand, for the tests of posts and files."""

from __future__ import annotations

import hashlib
from dataclasses import replace

import numpy as np

from trunnion.findings import Fix, info, remark, warning
from trunnion.geometry.cut import curve_cut, plane_cut
from trunnion.geometry.frame import WORLD, Frame
from trunnion.geometry.mesh import Mesh
from trunnion.model.blank import Box
from trunnion.model.feature import FaceRole, Feature, Recognition
from trunnion.model.fixture import Fixture
from trunnion.model.guides import GuideChain, GuideKind, LinkRelation
from trunnion.model.motion.program import Program, ProgramSection
from trunnion.model.motion.toolpath import ACROSS, Mark, Motion, Toolpath
from trunnion.model.operation import CuttingData, Operation, OperationPath
from trunnion.model.process import ProcessTree
from trunnion.model.repair import PlanScore, RepairRound
from trunnion.model.session import PartInfo, PostedFile, Session, SizeEntry, StepRecord
from trunnion.model.setup import Setup
from trunnion.model.tool import Holder, Insert, Tool, TurningTool
from trunnion.model.verdict import (
    BlockProof,
    Deviation,
    FaceProof,
    Offer,
    OperationProof,
    Outcome,
    Verdict,
)

GUIDES = (
    GuideChain(
        kind=GuideKind.WALL,
        faces=(12, 13, 14),
        on=(12, 13, 0),
        relations=(LinkRelation.TO, LinkRelation.PAST),
    ),
    GuideChain(kind=GuideKind.WALL, closed=True, on=(15,), relations=(LinkRelation.TANGENT,)),
    GuideChain(kind=GuideKind.AREA, closed=True, faces=(9,)),
)
"""Guide lines: an open one along two walls and on past a third face that is not known, one round a round wall, the rim of a floor."""
HOLDER = Holder(name="HSK63-ER32", rows=((0.0, 20.0, 10.0, 25.0), (10.0, 25.0, 60.0, 31.5)))
FLAT_16 = Tool(
    number=1,
    name="flat 16",
    form="flat",
    diameter=16.0,
    corner_radius=0.0,
    flute_length=32.0,
    neck_diameter=15.5,
    neck_length=50.0,
    shank_diameter=16.0,
    stickout=60.0,
    gauge_length=140.5,
    teeth=3,
    centre_cutting=True,
    helix_angle=40.0,
    holder=HOLDER,
    description="three flutes, for aluminium",
)
BULL_10 = replace(
    FLAT_16,
    number=7,
    name="bull 10 R1",
    form="bull",
    diameter=10.0,
    corner_radius=1.0,
    neck_diameter=9.5,
    shank_diameter=10.0,
    gauge_length=120.25,
)
TURNING = TurningTool(
    number=3,
    name="DCLNR CNMG120408",
    insert=Insert(designation="CNMG120408", inscribed_circle=12.7, thickness=4.76, nose_radius=0.8),
    edge_angle=95.0,
    hand="right",
    shank_height=25.0,
    shank_width=25.0,
    functional_length=150.0,
    functional_width=32.0,
    holder_name="DCLNR2525M12",
)
S1 = Setup(name="S1", frame=WORLD, work_offset="G54", clearance=50.0, machine="mill-3-axis")
S2 = Setup(
    name="S2",
    frame=Frame(
        np.array([100.0, 0.0, 40.0]), np.array([-1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0])
    ),
    work_offset="G55",
    clearance=30.0,
    machine="mill-3-axis",
)
CUTS = (
    plane_cut(3, (1.0, 2.0, 3.5), (0.0, 0.6, 0.8)),
    curve_cut(41, ((0.0, 0.0, 0.1), (5.0, 0.0, 0.2), (5.0, 4.0, 0.1))),
)
PART_BYTES = b"ISO-10303-21;\nHEADER;\nENDSEC;\nEND-ISO-10303-21;\n"

RAPID, LINE, CW, CCW = Motion.RAPID, Motion.LINE, Motion.ARC_CW, Motion.ARC_CCW


def path_of(*blocks: tuple) -> Toolpath:
    """Return a path of blocks (motion, x, y, z), (motion, x, y, z, feed) or (motion, x, y, z, centre x, centre y, feed)."""
    position = np.array([b[1:4] for b in blocks], dtype=float)
    centre = np.full((len(blocks), 3), np.nan)
    for n, b in enumerate(blocks):
        if len(b) == 7:
            centre[n] = (b[4], b[5], position[n - 1, 2])
    motion = np.array([int(b[0]) for b in blocks])
    return Toolpath(
        position=position,
        axis=np.tile([0.0, 0.0, 1.0], (len(blocks), 1)),
        motion=motion,
        centre=centre,
        feed=np.array([0.0 if b[0] == RAPID else b[-1] for b in blocks]),
        mark=np.where(motion == RAPID, Mark.RETRACT, Mark.CUT),
    )


POCKET = path_of(
    (RAPID, 20.0, 10.0, 50.0),
    (RAPID, 20.0, 10.0, 2.0),
    (LINE, 20.0, 10.0, 0.0, 300.0),
    (CCW, 20.0, 10.0, -2.5, 15.0, 10.0, 600.0),
    (CCW, 10.0, 10.0, -5.0, 15.0, 10.0, 600.0),
    (LINE, 10.0, 40.0, -5.0, 1200.0),
    (CW, 15.0, 45.0, -5.0, 15.0, 40.0, 1200.0),
    (LINE, 60.0, 45.0, -5.0, 1200.0),
    (CW, 60.0, 45.0, -5.0, 60.0, 25.0, 900.5),
    (RAPID, 60.0, 45.0, 50.0),
)
WALL = path_of(
    (RAPID, 0.0, 0.0, 50.0),
    (RAPID, 0.0, 0.0, -8.0),
    (LINE, 33.3333, 0.0, -8.0, 800.0),
    (RAPID, 33.3333, 0.0, 50.0),
)
BACK = path_of(
    (RAPID, 5.0, 5.0, 30.0),
    (LINE, 5.0, 5.0, -1.0, 100.0),
    (LINE, 95.0, 5.0, -1.0, 1500.0),
    (RAPID, 95.0, 5.0, 30.0),
)


def turned_path(*blocks: tuple) -> Toolpath:
    """Return a path of turning work of blocks as `path_of` has them, x from the work's axis and z in place of y."""
    flat = path_of(*((b[0], b[1], b[2], 0.0, *b[3:]) for b in blocks))
    return replace(
        flat,
        position=flat.position[:, [0, 2, 1]],
        centre=flat.centre[:, [0, 2, 1]],
        axis=np.tile(ACROSS, (len(blocks), 1)),
        work_turns=True,
    )


FACING = turned_path(
    (RAPID, 60.0, 50.0),
    (RAPID, 60.0, 5.0),
    (LINE, 60.0, -1.0, 191.0),
    (LINE, 10.0, -1.0, 500.0),
    (CW, 5.0, -6.0, 10.0, -6.0, 700.0),
    (CCW, 0.0, -11.0, 0.0, -6.0, 700.0),
    (RAPID, 0.0, 50.0),
)
"""A path of turning work: in, across the face, two quarters of circles."""


def section(
    operation: str, tool: Tool, path: Toolpath, spindle: float = 12000.0, coolant: str = "flood"
) -> ProgramSection:
    """Return one section of a program."""
    return ProgramSection(
        operation=operation, tool=tool, spindle=spindle, path=path, coolant=coolant
    )


def program_1() -> Program:
    """Return a program of three operations with two tools: helices, full circles, both senses of arcs."""
    sections = (
        section("pocket-01.rough", FLAT_16, POCKET),
        section("wall-01", FLAT_16, WALL, 14000.0),
        section("wall-02", BULL_10, WALL, 18000.0, "mist"),
    )
    return Program(name="B1.S1", setup=S1, sections=sections)


def program_2() -> Program:
    """Return the program of a second setup."""
    return Program(name="B1.S2", setup=S2, sections=(section("face-02", FLAT_16, BACK),))


def part_info() -> PartInfo:
    """Return what a session keeps of `PART_BYTES`."""
    return PartInfo(
        path="parts/B1.step",
        name="B1",
        digest=hashlib.sha256(PART_BYTES).hexdigest(),
        unit="mm",
        n_faces=42,
        n_solids=1,
        solid=1,
        area=1234.5,
        volume=6789.0,
        low=np.zeros(3),
        high=np.array([100.0, 60.0, 40.0]),
        findings=(info("part.unit", "the file is in mm"),),
    )


def recognition() -> Recognition:
    """Return features of every shape of attribute: nested pockets, an island, a rib, a refused one."""
    pocket = Feature(
        id="pocket-01",
        kind="pocket",
        by_hand=True,
        faces=(
            FaceRole(role="floor", face=3),
            FaceRole(role="wall", face=4),
            FaceRole(role="corner", face=5),
            FaceRole(role="floor_fillet", face=6),
        ),
        sizes={
            "depth": 20.0,
            "floor_z": 4,
            "corner_radius": 8.0,
            "leans": (0.0, 5.5),
            "top_z": 24.0,
        },
        attributes={"centre": (10.0, 20.0, 4.0), "through": False, "identification": "pocket"},
    )
    step = Feature(
        id="pocket-02",
        kind="open_pocket",
        faces=(FaceRole(role="wall", face=9),),
        sizes={},
        attributes={
            "nested_in": "pocket-01",
            "through": True,
            "direction": (0.0, 0.0, -1.0),
            "refused": "leaning wall 5° in",
        },
    )
    island = Feature(
        id="island-01",
        kind="island",
        faces=(FaceRole(role="top", face=11),),
        attributes={"in": "pocket-01"},
    )
    rib = Feature(
        id="rib-01", kind="rib", faces=(FaceRole(role="top", face=12),), sizes={"thickness": 4.0}
    )
    frame = Frame(
        np.array([1.0, 2.0, 3.0]), np.array([0.6, 0.8, 1e-9]), np.array([0.1, -0.2, 0.97])
    )
    return Recognition(
        family="panel",
        frame=frame,
        features=(pocket, step, island, rib),
        unexplained=(40, 41),
        unexplained_share=0.0123,
        removed=((40,), (41, 7)),
        findings=(
            warning(
                "panel.leaning-wall",
                "a wall leans by 5.5°",
                "face 9",
                remedy="choose a 5-axis plan",
            ),
        ),
    )


def process_tree() -> ProcessTree:
    """Return a plan with a suppressed operation, choices of every type and rules."""
    data = CuttingData(
        speed=500.0,
        spindle=12000.0,
        feed_per_tooth=0.1,
        feed=3600.0,
        plunge_feed=900.0,
        depth=2.5,
        width=8.0,
        removal_rate=72.0,
        power=1.8,
        power_limit=15.0,
        torque=1.43,
        rules=("vc from the catalogue",),
        widest=40.0,
        slot_share=0.75,
        peak_power=4.5,
        peak_torque=3.58,
        peak_at="the cutter enters at full width",
        routed_depth=3.5,
    )
    choices = {
        "plane.rough.stepover": 0.4,
        "plane.rough.climb": True,
        "plane.rough.levels": 3,
        "plane.rough.entry": "helix",
    }
    rough = Operation(
        id="pocket-01.rough",
        kind="rough",
        strategy="plane.rough",
        feature="pocket-01",
        setup="S1",
        tool=FLAT_16,
        data=data,
        choices=choices,
        rules=("largest cutter that passes the corners",),
    )
    wall = replace(
        rough,
        id="wall-01",
        kind="wall",
        strategy="plane.wall",
        faces=(4, 5),
        after=("pocket-01.rough",),
        by_hand=True,
        choices={},
    )
    last = replace(wall, id="wall-02", tool=BULL_10, group="finishing", suppressed=True)
    back = replace(rough, id="face-02", setup="S2", choices={})
    return ProcessTree(
        plan="panel-aluminium",
        material="al-7075",
        setups=(S1, S2),
        operations=(rough, wall, last, back),
        findings=(remark("route.air", "much air"),),
        removed=("rib_top-rib-01",),
    )


def verdict(outcome: Outcome = Outcome.PASSED) -> Verdict:
    """Return a verdict with proofs, findings and a deviation map."""
    face = FaceProof(
        face=4,
        area=100.0,
        finished=99.5,
        gouge=0.0,
        left_min=-0.001,
        left_mean=0.002,
        left_max=0.01,
        planned=True,
    )
    proof = OperationProof(
        operation="wall-01",
        setup="S1",
        outcome=outcome,
        gouge=0.001,
        collisions=0,
        rapids_in_stock=0,
        time_s=61.5,
        removed=1234.0,
        air_share=0.25,
        gouges=((4, 0.001),),
        left_min=-0.001,
        left_max=0.01,
        engaged=1.5,
        depth=2.0,
        rate=12.5,
        power=1.25,
        power_limit=20.0,
    )
    rng = np.random.default_rng(3)
    deviation = Deviation(
        face=np.arange(40), point=rng.normal(size=(40, 3)), deviation=rng.normal(size=40)
    )
    small = np.linspace(0.0, 1.0, 40, dtype=np.float32)
    blocks = BlockProof(
        setup="S1",
        section=np.arange(40, dtype=np.int32),
        time=small,
        gouge=small,
        collision=small,
        removed=small,
        engaged=small,
        depth=small,
        rate=small,
        power=small,
        left_min=small,
        left_mean=small,
        left_max=small,
    )
    offer = Offer(
        kind="feed",
        operation="wall-01",
        setup="S1",
        reason="verify.load",
        first=3,
        last=5,
        feed=1200.0,
    )
    return Verdict(
        outcome=outcome,
        blocks=(blocks,),
        offers=(offer,),
        coverage=0.9951,
        reachable=0.999,
        gouge=0.0012,
        collisions=0,
        rapids_in_stock=0,
        machining_time_s=600.5,
        operations=(proof,),
        faces=(face,),
        deviation=deviation,
        findings=(remark("verify.air", "a quarter is air", "wall-01"),),
    )


def session() -> Session:
    """Return a session in which every field holds something."""
    blank = Box(
        frame=WORLD,
        low=np.array([-5.0, -5.0, 0.0]),
        high=np.array([105.0, 65.0, 42.0]),
        material="al-7075",
        density=2.81,
    )
    sizes = (
        SizeEntry(
            name="depth",
            value=20.0,
            unit="mm",
            feature="pocket-01",
            faces=(3, 4),
            at=(1.0, 2.0, 3.5),
        ),
    )
    paths = (
        OperationPath(
            operation="pocket-01.rough",
            path=POCKET,
            findings=(info("rough.left", "a corner is left"),),
            key="k1",
        ),
        OperationPath(operation="wall-01", path=WALL, key="k2", guides=GUIDES),
    )
    posted = (
        PostedFile(suffix="S1.nc", dialect="linuxcnc", setup="S1", text="(A)\nN10 G0 X0\n" * 300),
    )
    records = {
        "recognize": StepRecord(key="r1", seconds=0.5),
        "verify": StepRecord(key="v1", seconds=2.0, findings=verdict().findings),
    }
    slower = Fix(kind="feed", operation="wall-01", reason="verify.power", amount=0.8)
    score = PlanScore(errors=1, is_short=False, harms=0, unfinished=0.25, remarks=1, time=95.5)
    repairs = (
        RepairRound(
            number=1,
            fixes=(slower,),
            findings=("wall-01 asks 41 kW",),
            before=score,
            after=replace(score, errors=0),
            kept=True,
        ),
        RepairRound(
            number=2,
            fixes=(replace(slower, kind="add_operation", faces=(3, 4)),),
            findings=("too little",),
            before=score,
            after=None,
            kept=False,
            refusal="no cutter",
        ),
    )
    choices = {
        "blank.side": 5,
        "route.plan": "panel-aluminium",
        "verify.limit": 0.02,
        "blank.box": True,
    }
    clamp = Mesh(
        [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)],
        [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)],
        np.ones(4, int),
    )
    return Session(
        part=part_info(),
        cuts=CUTS,
        fixtures=(Fixture(name="clamp", mesh=clamp, setup="S2"),),
        choices=choices,
        recognition=recognition(),
        sizes=sizes,
        blank=blank,
        setups=(S1, S2),
        process=process_tree(),
        paths=paths,
        posted=posted,
        verdict=verdict(),
        repairs=repairs,
        records=records,
    )


def program_from(listing: str) -> Program:
    """Return the program that a neutral listing with marks says: how goldens write their input."""
    setups, marks = {"S1": S1, "S2": S2}, {m.name.lower(): int(m) for m in Mark}
    motions = {"rapid": RAPID, "line": LINE, "arc-cw": CW, "arc-ccw": CCW}
    first, *lines = [
        line.split() for line in listing.splitlines() if line and not line.startswith("#")
    ]
    heads, blocks = [], []
    for words in lines:
        if words[0] == "operation":
            heads.append(words)
            blocks.append([])
        else:
            numbers = [float(w) for w in words if w[-1].isdigit()]
            blocks[-1].append((motions[words[0]], *numbers, marks[words[-1]]))
    sections = []
    for (_, id, _, tool, _, spindle, _, coolant), rows in zip(heads, blocks, strict=True):
        path = replace(
            path_of(*(row[:-1] for row in rows)), mark=np.array([row[-1] for row in rows])
        )
        sections.append(
            section(id, {1: FLAT_16, 7: BULL_10}[int(tool)], path, float(spindle), coolant)
        )
    return Program(name=f"B1.{first[1]}", setup=setups[first[1]], sections=tuple(sections))
