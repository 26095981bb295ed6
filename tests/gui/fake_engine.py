"""An engine with a made-up part: a plate with three pockets and a rib as a mesh of boxes. Slow, crashing and deaf ones too.

Everything is worked out at once from the declared settings, so that the window's tests take no time.
"""

from __future__ import annotations

import hashlib
import json
import os
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from trunnion.findings import BadInput, remark, warning
from trunnion.geometry.frame import Frame
from trunnion.geometry.mesh import Mesh
from trunnion.model.blank import Box
from trunnion.model.feature import FaceRole, Feature, Recognition, TakenFor
from trunnion.model.guides import GuideChain, GuideCurve, GuideKind, LinkRelation, OperationGuides
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.model.operation import CuttingData, Operation, OperationPath
from trunnion.model.process import ProcessTree
from trunnion.model.session import PartInfo, PostedFile, Session, SizeEntry, StepRecord
from trunnion.model.setup import Setup
from trunnion.model.tool import Holder, Tool
from trunnion.model.verdict import Deviation, OperationProof, Outcome, Verdict
from trunnion.post.header import STAMP_LINES, plan_digest
from trunnion.post.release import release
from trunnion.progress import NO_PROGRESS
from trunnion.settings import choose, digest, setting, settings
from trunnion.store.project import load_project, save_project

PART_BYTES = b"a made-up part"
PART_DIGEST = hashlib.sha256(PART_BYTES).hexdigest()
STEPS = ("recognize", "size", "blank", "route", "optimize", "toolpath", "verify", "repair")
LENGTH, WIDTH, HEIGHT, FLOOR = 240.0, 140.0, 30.0, 6.0
FINDINGS = {
    "recognize": (
        warning(
            "panel.leaning-wall",
            "a wall leans over the floor",
            "pocket-01",
            "face 2",
            remedy="machine it with five axes",
        ),
    ),
    "route": (remark("fake.time", "two pockets could share a cutter", "pocket-02", "pocket-03"),),
}
FASTEST = 20_000.0
"""Highest feed of the made-up machine, mm/min."""
POCKETS = ((8.0, 8.0, 112.0, 132.0), (118.0, 8.0, 232.0, 66.0), (118.0, 74.0, 232.0, 132.0))


@settings("fake.blank")
class BlankSettings:
    """Allowances of the made-up blank."""

    side: float = setting(
        5.0,
        unit="mm",
        low=0.0,
        high=50.0,
        label="Allowance at the sides",
        help="Material around the part.",
    )
    top: float = setting(
        2.0,
        unit="mm",
        low=0.0,
        high=50.0,
        label="Allowance on top",
        help="Material above the part.",
    )
    material: str = setting(
        "al-7075",
        label="Material",
        help="What the blank is made of.",
        choices=("al-7075", "ti-6al4v"),
    )


@settings("fake.rough")
class RoughSettings:
    """How the made-up pockets are roughed."""

    stepover: float = setting(
        0.4, unit="of diameter", low=0.05, high=0.95, label="Stepover", help="Width of cut."
    )
    layers: int = setting(4, unit="", low=1, high=50, label="Layers", help="How many levels.")
    climb: bool = setting(True, label="Climb milling", help="Material on the right of the cutter.")


def box_mesh() -> tuple[Mesh, dict[str, list[tuple[str, int]]]]:
    """Return the plate's mesh and, by feature id, roles with face tags."""
    points: list[np.ndarray] = []
    triangles: list[tuple[int, int, int]] = []
    faces: list[int] = []
    features: dict[str, list[tuple[str, int]]] = {}
    tag = 0

    def quad(feature: str, role: str, *corners: tuple[float, float, float]) -> None:
        nonlocal tag
        tag += 1
        base = len(points)
        points.extend(np.array(c) for c in corners)
        triangles.extend([(base, base + 1, base + 2), (base, base + 2, base + 3)])
        faces.extend([tag, tag])
        features.setdefault(feature, []).append((role, tag))

    def top_piece(feature: str, x0: float, y0: float, x1: float, y1: float) -> None:
        quad(feature, "top", (x0, y0, HEIGHT), (x1, y0, HEIGHT), (x1, y1, HEIGHT), (x0, y1, HEIGHT))

    for n, (x0, y0, x1, y1) in enumerate(POCKETS, 1):
        id = f"pocket-{n:02d}"
        quad(id, "floor", (x0, y0, FLOOR), (x1, y0, FLOOR), (x1, y1, FLOOR), (x0, y1, FLOOR))
        ring = ((x0, y0), (x0, y1), (x1, y1), (x1, y0))
        for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1]):
            quad(id, "wall", (ax, ay, FLOOR), (bx, by, FLOOR), (bx, by, HEIGHT), (ax, ay, HEIGHT))
    top_piece("rib-01", 112, 8, 118, 132)
    top_piece("rib-02", 118, 66, 232, 74)
    for piece in (
        (0, 0, LENGTH, 8),
        (0, 132, LENGTH, WIDTH),
        (0, 8, 8, 132),
        (232, 8, LENGTH, 132),
    ):
        top_piece("datum-01", *piece)
    quad("datum-01", "bottom", (0, 0, 0), (0, WIDTH, 0), (LENGTH, WIDTH, 0), (LENGTH, 0, 0))
    ring = ((0.0, 0.0), (LENGTH, 0.0), (LENGTH, WIDTH), (0.0, WIDTH))
    for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1]):
        quad("profile-01", "wall", (ax, ay, 0), (bx, by, 0), (bx, by, HEIGHT), (ax, ay, HEIGHT))
    return Mesh(np.array(points), np.array(triangles), np.array(faces)), features


def cutter(number: int, diameter: float) -> Tool:
    """Return a made-up end mill."""
    return Tool(
        number=number,
        name=f"EM{diameter:g}",
        form="bull",
        diameter=diameter,
        corner_radius=3.0,
        flute_length=40,
        neck_diameter=diameter - 1,
        neck_length=50,
        shank_diameter=diameter,
        stickout=60,
        gauge_length=130,
        teeth=3,
        centre_cutting=True,
        helix_angle=40,
        holder=Holder(name="SK40", rows=((0, 20, 50, 25),)),
        description=f"End mill D{diameter:g} R3, carbide",
    )


def cutting(speed: float, diameter: float) -> CuttingData:
    """Return made-up cutting data."""
    spindle = speed * 1000 / (np.pi * diameter)
    return CuttingData(
        speed=speed,
        spindle=spindle,
        feed_per_tooth=0.12,
        feed=spindle * 0.36,
        plunge_feed=spindle * 0.1,
        depth=6,
        width=8,
        removal_rate=120,
        power=7.4,
        power_limit=18,
        torque=6.1,
        rules=("vc from the material's table",),
    )


def zigzag(box: tuple[float, float, float, float], z: float, step: float) -> Toolpath:
    """Return a made-up path: a helix down, loops of lines, up again."""
    x0, y0, x1, y1 = box
    cx, cy = (x0 + x1) / 2, (y0 + y1) / 2
    rows: list[
        tuple[tuple[float, float, float], Motion, Mark, tuple[float, float, float] | None]
    ] = [
        ((cx + 5, cy, 40.0), Motion.RAPID, Mark.RETRACT, None),
        ((cx + 5, cy, 2.0), Motion.LINE, Mark.RETRACT, None),
    ]
    for turn in range(6):
        low = 2.0 + (z - 2.0) * (turn + 1) / 6
        rows.append(((cx + 5, cy, low), Motion.ARC_CCW, Mark.ENTRY, (cx, cy, low)))
    y = y0 + 10
    while y < y1 - 10:
        rows.append(((x0 + 10, y, z), Motion.LINE, Mark.LINK, None))
        rows.append(((x1 - 10, y, z), Motion.LINE, Mark.CUT, None))
        y += step
    rows.append(((x1 - 14, y - step + 4, z), Motion.ARC_CCW, Mark.LEAD, (x1 - 14, y - step, z)))
    rows.append(((x1 - 14, y - step + 4, 40.0), Motion.RAPID, Mark.RETRACT, None))
    return Toolpath(
        position=np.array([r[0] for r in rows]),
        axis=np.tile([0.0, 0, 1], (len(rows), 1)),
        motion=np.array([r[1] for r in rows]),
        mark=np.array([r[2] for r in rows]),
        centre=np.array([r[3] or (np.nan,) * 3 for r in rows]),
        feed=np.array([0.0 if r[1] is Motion.RAPID else 2400.0 for r in rows]),
    )


HEADER = (
    "%",
    "(tray)",
    "N10 G21 G90 G17",
    "N20 T1 M6",
    "N30 S7200 M3",
    "N40 G0 X10. Y20. Z40.",
    "N50 G1 Z-24. F800.",
    "N60 G2 X20. Y30. I5. J5. F2400.",
)
"""The first lines of the made-up program; a line for each block follows."""
GOUGE, LEFT = (175.0, 37.0), (175.0, 103.0)
"""Where the made-up proof found a gouge of 50 µm in the second pocket's floor, and 0.2 mm left in the third's."""
SPOT = 9.0
"""Radius of both spots, mm."""


def posted_text(session: Session) -> str:
    """Return the made-up program of a session."""
    words = [
        f"G{min(int(m), 1)} X{x:.3f} Y{y:.3f} Z{z:.3f}"
        for p in session.paths
        for m, (x, y, z) in zip(p.path.motion, p.path.position, strict=True)
    ]
    return "\n".join([*HEADER, *words, "M30", "%", ""])


def measured(mesh: Mesh, features: dict[str, list[tuple[str, int]]]) -> Deviation:
    """Return samples 4 mm apart on the pockets' floors, all finished but for the two spots."""
    faces, points, found = [], [], []
    for id, (x0, y0, x1, y1) in zip(("pocket-01", "pocket-02", "pocket-03"), POCKETS, strict=True):
        floor = next(tag for role, tag in features[id] if role == "floor")
        x, y = np.meshgrid(np.arange(x0 + 2, x1, 4.0), np.arange(y0 + 2, y1, 4.0))
        place = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, FLOOR)])
        value = np.where(np.hypot(*(place[:, :2] - GOUGE).T) < SPOT, -0.05, 0.0)
        value[np.hypot(*(place[:, :2] - LEFT).T) < SPOT] = 0.2
        faces.append(np.full(len(place), floor))
        points.append(place)
        found.append(value)
    return Deviation(
        face=np.concatenate(faces), point=np.vstack(points), deviation=np.concatenate(found)
    )


class FakeEngine:
    """Answers what `trunnion.pipeline.Engine` answers, about the made-up plate."""

    pause = 0.0

    def __init__(self, user_folder: Path | None = None) -> None:
        self._mesh, self._features = box_mesh()
        self._attached = ""
        self._playback = None

    def playback(self, session, cell=0.0, progress=NO_PROGRESS):
        from trunnion.pipeline.proof.playback import Playback
        from trunnion.shop import load_shop

        machine = next(iter(load_shop().machines.values()))
        self._playback = Playback(
            session, SimpleNamespace(shop=SimpleNamespace(machines={"vmc": machine})), 1.0
        )
        line = self._playback.timeline
        return replace(
            line,
            line=np.arange(len(line)) + len(HEADER) + 1,
            passages=tuple(replace(p, file="S1.nc") for p in line.passages),
        )

    def moment(self, key, position, seconds=np.inf, progress=NO_PROGRESS):
        return self._playback.towards(position, seconds, progress)

    def guides(self, session, id, progress=NO_PROGRESS):
        """Return the loop round the floor of the operation's pocket; of others why there is none."""
        operation = session.process.operation(id)
        name, _, number = operation.feature.rpartition("-")
        if name != "pocket":
            return OperationGuides(operation=id, refused=f"{id}: nothing leads it")
        x0, y0, x1, y1 = POCKETS[int(number) - 1]
        ring = [(x0, y0, FLOOR), (x1, y0, FLOOR), (x1, y1, FLOOR), (x0, y1, FLOOR)]
        line = GuideCurve(
            chain=GuideChain(
                kind=GuideKind.WALL, closed=True, on=(0,) * 4, relations=(LinkRelation.TO,) * 4
            ),
            points=np.array([*ring, ring[0]], float),
            corners=np.array(ring, float),
        )
        return OperationGuides(operation=id, lines=(line,))

    def deviation_map(self, session, progress=NO_PROGRESS):
        from trunnion.report.deviation import deviation_map

        return deviation_map(self._mesh, session.verdict.deviation, 0.02)

    def settings(self) -> dict[str, tuple[type, ...]]:
        return dict.fromkeys(STEPS, ()) | {"blank": (BlankSettings,), "toolpath": (RoughSettings,)}

    def open(self, path, *, solid=None, progress=NO_PROGRESS) -> Session:
        progress.at(0.5, "reading the part")
        path = Path(path)
        if not path.exists():
            raise BadInput(f"{path.name} can't be read: there is no such file")
        if path.suffix == ".trunnion":
            session, _, _ = load_project(path)
        elif path.suffix not in (".step", ".igs", ".stpz"):
            raise BadInput(
                f"{path.name} is neither STEP nor IGES: export the part as STEP AP214 or AP242"
            )
        else:
            session = Session(
                part=PartInfo(
                    path=str(path),
                    name=path.stem,
                    digest=PART_DIGEST,
                    unit="mm",
                    n_faces=int(self._mesh.face.max()),
                    n_solids=1,
                    solid=1,
                    area=1e5,
                    volume=4e5,
                    low=np.zeros(3),
                    high=np.array([LENGTH, WIDTH, HEIGHT]),
                )
            )
        self._attached = session.part.name
        return session

    def keep(self) -> tuple[bytes, str]:
        return PART_BYTES, ".step"

    def attach(self, session, data=b"", suffix="", progress=NO_PROGRESS) -> None:
        self._attached = session.part.name

    def mesh(self, session, progress=NO_PROGRESS) -> Mesh:
        return self._mesh

    def save(self, session, path, progress=NO_PROGRESS) -> None:
        save_project(session, path, *self.keep())

    def write(self, session, folder, *, name="", date="", progress=NO_PROGRESS) -> tuple[str, ...]:
        Path(folder).mkdir(parents=True, exist_ok=True)
        for f in session.posted:
            (Path(folder) / f"{session.part.name}.{f.suffix}").write_text(f.text)
        return tuple(f"{session.part.name}.{f.suffix}" for f in session.posted)

    def states(self, session) -> dict[str, str]:
        states, is_stale = {}, False
        for step in STEPS:
            record = session.records.get(step)
            is_stale = is_stale or (record is not None and record.key != self._key(session, step))
            states[step] = "empty" if record is None else "stale" if is_stale else "done"
        return states

    def run(self, session, until="repair", progress=NO_PROGRESS) -> Session:
        for step in STEPS[: STEPS.index(until) + 1]:
            if self.states(session)[step] == "done":
                continue
            for tick in range(10):
                progress.at(tick / 10, f"{step} {tick}")
                self.work(step, tick)
            session = getattr(self, f"_{step}")(session)
            record = StepRecord(
                key=self._key(session, step), seconds=0.42, findings=FINDINGS.get(step, ())
            )
            session = replace(session, records=dict(session.records) | {step: record})
        return session

    def work(self, step: str, tick: int) -> None:
        time.sleep(self.pause)

    def _key(self, session: Session, step: str) -> str:
        groups = [choose(c, session.choices) for c in self.settings()[step]]
        features = (
            [f.as_dict() for f in session.recognition]
            if session.recognition and step != "recognize"
            else []
        )
        tree = [
            (o.id, o.suppressed, dict(o.choices))
            for o in (session.process.operations if session.process else ())
            if step in ("toolpath", "verify")
        ]
        return digest(step, *groups, json.dumps(features), tree)

    def _recognize(self, session: Session) -> Session:
        features = tuple(
            Feature(
                id=id,
                kind=id[:-3],
                faces=tuple(FaceRole(role=r, face=t) for r, t in faces),
                sizes={
                    "depth": HEIGHT - FLOOR,
                    "floor_z": FLOOR,
                    "top_z": HEIGHT,
                    "corner_radius": 8.0,
                    "leans": (0.0, 2.5),
                }
                if id.startswith("pocket")
                else {"thickness": 6.0},
            )
            for id, faces in self._features.items()
        )
        return replace(
            session,
            recognition=Recognition(
                family="panel",
                features=features,
                face_area=np.bincount(self._mesh.face, self._mesh.areas())[1:],
            ),
        )

    def _size(self, session: Session) -> Session:
        rows = [
            SizeEntry(
                name="depth",
                value=HEIGHT - FLOOR,
                unit="mm",
                feature=f.id,
                faces=f.with_role("floor"),
                at=((b[0] + b[2]) / 2, (b[1] + b[3]) / 2, FLOOR),
            )
            for f, b in zip(session.recognition.of_kind("pocket"), POCKETS)
        ]
        return replace(session, sizes=tuple(rows))

    def _blank(self, session: Session) -> Session:
        chosen = choose(BlankSettings, session.choices)
        low = np.array([-chosen.side, -chosen.side, 0.0])
        high = np.array([LENGTH + chosen.side, WIDTH + chosen.side, HEIGHT + chosen.top])
        return replace(
            session,
            blank=Box(
                frame=session.recognition.frame,
                low=low,
                high=high,
                material=chosen.material,
                density=2.81,
            ),
        )

    def _route(self, session: Session) -> Session:
        setup = Setup(
            name="S1",
            frame=Frame(np.array([0, 0, HEIGHT]), np.array([1.0, 0, 0]), np.array([0, 0, 1.0])),
            work_offset="G54",
            clearance=40.0,
            machine="vmc",
        )
        operations = [
            Operation(
                id="op-01",
                kind="face",
                strategy="fake.face",
                feature="datum-01",
                setup="S1",
                tool=cutter(1, 63.0),
                data=cutting(600, 63),
                rules=("the top is faced first",),
            )
        ]
        for n, f in enumerate(session.recognition.of_kind("pocket"), 1):
            rough = f"op-{2 * n:02d}"
            operations += [
                Operation(
                    id=rough,
                    kind="rough",
                    strategy="fake.rough",
                    feature=f.id,
                    setup="S1",
                    tool=cutter(2, 20.0),
                    data=cutting(450, 20),
                    after=("op-01",),
                    rules=("largest cutter that fits the corners",),
                ),
                Operation(
                    id=f"op-{2 * n + 1:02d}",
                    kind="finish",
                    strategy="fake.rough",
                    feature=f.id,
                    setup="S1",
                    tool=cutter(3, 16.0),
                    data=cutting(500, 16),
                    faces=f.tags,
                    after=(rough,),
                ),
            ]
        return replace(
            session,
            setups=(setup,),
            process=ProcessTree(
                plan="panel-5-side",
                material="al-7075",
                setups=(setup,),
                operations=tuple(operations),
            ),
        )

    def _optimize(self, session: Session) -> Session:
        return session

    def _toolpath(self, session: Session) -> Session:
        boxes = dict(zip(("pocket-01", "pocket-02", "pocket-03"), POCKETS))
        paths = tuple(
            OperationPath(
                operation=o.id,
                path=zigzag(
                    boxes.get(o.feature, (0, 0, LENGTH, WIDTH)),
                    FLOOR - HEIGHT if o.feature in boxes else 0.0,
                    o.tool.diameter * 0.4,
                ),
            )
            for o in session.process.operations
        )
        return replace(session, paths=paths)

    def _repair(self, session: Session) -> Session:
        return session

    def with_fix(self, session: Session, fix) -> Session:
        changed = replace(session.process.operation(fix.operation), suppressed=True)
        return replace(session, process=session.process.with_operation(changed))

    def with_operation_change(self, session: Session, id: str, change) -> Session:
        operation = session.process.operation(id)
        if change.feed > FASTEST:
            raise BadInput(f"{id}: the machine feeds at most {FASTEST:.0f} mm/min")
        data = replace(
            operation.data,
            feed=change.feed or operation.data.feed,
            spindle=change.spindle or operation.data.spindle,
        )
        tool = replace(operation.tool, name=change.tool or operation.tool.name)
        changed = replace(operation, data=data, tool=tool, by_hand=True)
        return replace(session, process=session.process.with_operation(changed))

    def _verify(self, session: Session) -> Session:
        proofs = tuple(
            OperationProof(
                operation=o.id,
                setup="S1",
                outcome=Outcome.PASSED,
                gouge=0.0,
                collisions=0,
                rapids_in_stock=0,
                time_s=95.0,
                removed=2e4,
                air_share=0.1,
                cutting_s=70.0,
                air_s=10.0,
                rapid_s=9.0,
                bound_s=50.0,
            )
            for o in session.process.operations
        )
        verdict = Verdict(
            outcome=Outcome.PASSED,
            coverage=0.996,
            reachable=1.0,
            gouge=0.004,
            collisions=0,
            rapids_in_stock=0,
            machining_time_s=754.0,
            bound_s=500.0,
            operations=proofs,
            deviation=measured(self._mesh, self._features),
        )
        text = posted_text(session)
        return replace(
            session,
            verdict=verdict,
            posted=(PostedFile(suffix="S1.nc", dialect="linuxcnc", setup="S1", text=text),),
        )


class SlowEngine(FakeEngine):
    """Takes three seconds a step and looks at cancel."""

    pause = 0.3


class DeafEngine(FakeEngine):
    """Never looks at cancel while it works on a toolpath."""

    def work(self, step: str, tick: int) -> None:
        if step == "toolpath":
            time.sleep(60.0)


class CrashingEngine(FakeEngine):
    """Dies in the middle of a toolpath, as a fault inside a compiled library would."""

    def work(self, step: str, tick: int) -> None:
        if step == "toolpath" and tick == 5:
            os._exit(139)


def swaying(box: tuple[float, float, float, float], z: float, tilt: float) -> Toolpath:
    """Return a made-up path along a box whose tool sways from one side to the other, by so many radians across x."""
    x0, y0, x1, y1 = box
    x = np.linspace(x0 + 20, x1 - 20, 21)
    lean = tilt * np.sin(np.linspace(0.0, 2 * np.pi, 21))
    way = np.column_stack([x, np.full(21, (y0 + y1) / 2), np.full(21, z)])
    position = np.vstack([way[:1] + (0, 0, 60.0), way, way[-1:] + (0, 0, 60.0)])
    axis = np.column_stack([np.sin(lean), np.zeros(21), np.cos(lean)])
    n = len(position)
    return Toolpath(
        position=position,
        axis=np.vstack([axis[:1], axis, axis[-1:]]),
        centre=np.full((n, 3), np.nan),
        motion=np.array([Motion.RAPID] + [Motion.LINE] * (n - 2) + [Motion.RAPID]),
        mark=np.array([Mark.RETRACT] * 2 + [Mark.CUT] * (n - 3) + [Mark.RETRACT]),
        feed=np.array([0.0] + [900.0] * (n - 2) + [0.0]),
    )


class AreasEngine(FakeEngine):
    """Takes the plate for a part of family surface: its pockets are groups, each finished as an area."""

    def context_of(self, session):
        from trunnion.shop import load_shop

        machine = next(iter(load_shop().machines.values()))
        area = np.bincount(self._mesh.face, weights=self._mesh.areas())[1:]
        return SimpleNamespace(
            part=SimpleNamespace(graph=lambda: SimpleNamespace(area=area)),
            shop=SimpleNamespace(machine=lambda name: machine),
        )

    def _recognize(self, session: Session) -> Session:
        session = super()._recognize(session)
        found = session.recognition
        groups = tuple(
            replace(f, kind="group", attributes={"local": f.id.startswith("rib")})
            for f in found.features
        )
        return replace(session, recognition=replace(found, family="surface", features=groups))

    def _route(self, session: Session) -> Session:
        found = session.recognition
        as_pockets = tuple(replace(f, kind=f.id[:-3]) for f in found.features)
        return replace(
            super()._route(replace(session, recognition=replace(found, features=as_pockets))),
            recognition=found,
        )


class SwayingEngine(FakeEngine):
    """Its second operation is cut with a tool that leans by up to 30 degrees to either side."""

    def _toolpath(self, session: Session) -> Session:
        session = super()._toolpath(session)
        path = swaying(POCKETS[0], -10.0, np.radians(30.0))
        return replace(
            session,
            paths=tuple(
                replace(p, path=path) if p.operation == "op-02" else p for p in session.paths
            ),
        )


class FailingEngine(FakeEngine):
    """Its proof finds a gouge; its programs carry the plan they belong to, so that they may be stamped."""

    def _verify(self, session: Session) -> Session:
        session = super()._verify(session)
        text = "\n".join(
            [
                *("(stamp)" for _ in range(STAMP_LINES)),
                f"(PLAN {plan_digest(session)})",
                *HEADER,
                "M30",
                "%",
                "",
            ]
        )
        return replace(
            session,
            verdict=replace(session.verdict, outcome=Outcome.FAILED, gouge=0.05),
            posted=(PostedFile(suffix="S1.nc", dialect="linuxcnc", setup="S1", text=text),),
        )

    def write(self, session, folder, *, name="", date="", progress=NO_PROGRESS) -> tuple[str, ...]:
        return super().write(replace(session, posted=release(session)), folder)


class SoundEngine(FakeEngine):
    """Its proof measured nothing that is too low or too high."""

    def _verify(self, session: Session) -> Session:
        session = super()._verify(session)
        measured = session.verdict.deviation
        return replace(
            session,
            verdict=replace(
                session.verdict, deviation=replace(measured, deviation=np.zeros(len(measured.face)))
            ),
        )


class FaultyEngine(FakeEngine):
    """Has a bug in its route."""

    def _route(self, session: Session) -> Session:
        raise ZeroDivisionError("division by zero")


class RefusingEngine(FakeEngine):
    """Recognises a part, but has no plan for its family."""

    def _route(self, session: Session) -> Session:
        raise BadInput("tray.step: parts of this family are not planned yet")


class DoubtingEngine(FakeEngine):
    """Takes the plate for a casing, which no family serves, until a person chooses a family."""

    def settings(self) -> dict[str, tuple[type, ...]]:
        from trunnion.pipeline.planning.family import RecognizeSettings

        return super().settings() | {"recognize": (RecognizeSettings,)}

    def _recognize(self, session: Session) -> Session:
        session = super()._recognize(session)
        chosen = session.choices.get("recognize.family", "auto")
        if chosen != "auto":
            taken = TakenFor(
                kind=str(chosen),
                noun=f"a {chosen}",
                score=0.12,
                reason="12 % of the area level or upright",
            )
            return replace(
                session,
                recognition=replace(session.recognition, family=str(chosen), taken_for=taken),
            )
        taken = TakenFor(
            kind="casing",
            noun="a casing",
            score=0.97,
            reason="96 % of the area is of revolution, <thin>",
        )
        tags = tuple(range(1, session.part.n_faces + 1))
        return replace(
            session,
            recognition=Recognition(
                family="casing",
                unexplained=tags,
                unexplained_share=1.0,
                taken_for=taken,
                doubt="the part looks like a casing: choose recognize.family = panel or surface",
            ),
        )

    def _size(self, session: Session) -> Session:
        if session.recognition.doubt:
            raise BadInput(session.recognition.doubt)
        return super()._size(session)


class UnsureEngine(DoubtingEngine):
    """Takes the plate for a panel, and explains little of it."""

    def _recognize(self, session: Session) -> Session:
        found = super()._recognize(
            replace(session, choices={**session.choices, "recognize.family": "panel"})
        )
        doubt = (
            ""
            if session.choices.get("recognize.family", "auto") != "auto"
            else "88 % of the area is explained by no feature"
        )
        return replace(
            found,
            choices=session.choices,
            recognition=replace(
                found.recognition, family="surface", unexplained_share=0.88, doubt=doubt
            ),
        )
