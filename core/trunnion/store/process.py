"""The process-tree XML: setups, tools and operations in the order they are cut, each choice with its rule."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from lxml import etree

from trunnion.findings import BadCall, BadInput
from trunnion.model.guides import GuideChain
from trunnion.model.operation import Operation, OperationPath
from trunnion.model.process import ProcessTree
from trunnion.model.session import PartInfo, Session
from trunnion.model.tool import AnyTool, Tool, TurningTool
from trunnion.store import xml
from trunnion.store.atomic import write_bytes
from trunnion.store.pieces import (
    add,
    add_findings,
    add_frame,
    add_values,
    attributes,
    text_of,
)

FORMAT = 1
UPRIGHT = (0.0, 0.0, 1.0)
"""The direction of a tool that comes along the setup's z: it isn't written."""


def write_process(session: Session, path: str | Path) -> None:
    """Write the process tree of a session as XML that fits the schema; raise `BadCall` while there is none."""
    if session.part is None or session.process is None:
        raise BadCall("no operations yet: generate the route first")
    write_bytes(path, process_xml(session.process, session.part, session.paths))


def process_xml(process: ProcessTree, part: PartInfo, paths: Sequence[OperationPath] = ()) -> bytes:
    """Return the XML of a process tree made for a part, with the guide lines of the toolpaths that are there."""
    root = etree.Element(
        "process-tree", version=str(FORMAT), plan=process.plan, material=process.material
    )
    add(root, "part", name=part.name, digest=part.digest)
    for setup in process.setups:
        element = etree.SubElement(root, "setup", attributes(setup))
        add_frame(element, setup.frame)
    tools = _tools(process).values()
    for rotating in (t for t in tools if isinstance(t, Tool)):
        _add_tool(root, rotating)
    for turning in (t for t in tools if isinstance(t, TurningTool)):
        _add_turning_tool(root, turning)
    guides = {path.operation: path.guides for path in paths}
    for operation in process.operations:
        _add_operation(root, operation, guides.get(operation.id, ()))
    for id in process.removed:
        add(root, "removed", operation=id)
    add_findings(root, process.findings)
    return xml.written(xml.validated(root, "process", "process tree"))


def _tools(process: ProcessTree) -> dict[int, AnyTool]:
    found: dict[int, AnyTool] = {}
    for operation in process.operations:
        tool = operation.tool
        if found.setdefault(tool.number, tool) != tool:
            raise BadInput(
                f"operation {operation.id}: two tools have the number {tool.number}: {found[tool.number].name} and {tool.name}"
            )
    return dict(sorted(found.items()))


def _add_tool(root: Any, tool: Tool) -> None:
    element = etree.SubElement(root, "tool", attributes(tool))
    for r, z, bulge in tool.outline:
        add(element, "point", r=text_of(float(r)), z=text_of(float(z)), bulge=text_of(float(bulge)))
    holder = add(element, "holder", name=tool.holder.name)
    for z0, r0, z1, r1 in tool.holder.rows:
        add(
            holder,
            "cone",
            z0=text_of(float(z0)),
            r0=text_of(float(r0)),
            z1=text_of(float(z1)),
            r1=text_of(float(r1)),
        )


def _add_turning_tool(root: Any, tool: TurningTool) -> None:
    element = etree.SubElement(root, "turning-tool", attributes(tool))
    etree.SubElement(element, "insert", attributes(tool.insert))


def _add_operation(root: Any, operation: Operation, guides: tuple[GuideChain, ...]) -> None:
    element = etree.SubElement(
        root, "operation", {**attributes(operation), "tool": str(operation.tool.number)}
    )
    cutting = etree.SubElement(element, "cutting", attributes(operation.data))
    for rule in operation.data.rules:
        add(cutting, "rule", rule)
    for tag in operation.faces:
        add(element, "face", tag=str(tag))
    for chain in guides:
        _add_guide(element, chain)
    for other in operation.others:
        add(element, "feature", id=other)
    for before in operation.after:
        add(element, "after", operation=before)
    add_values(element, "choice", "key", operation.choices)
    for rule in operation.rules:
        add(element, "rule", rule)
    if operation.direction != UPRIGHT:
        x, y, z = (text_of(float(v)) for v in operation.direction)
        add(element, "direction", x=x, y=y, z=z)
    for box in operation.avoid:
        (x0, y0), (x1, y1) = (tuple(text_of(float(v)) for v in end) for end in (box.low, box.high))
        add(element, "avoid", x0=x0, y0=y0, x1=x1, y1=y1, top=text_of(float(box.top)))


def _add_guide(parent: Any, chain: GuideChain) -> None:
    """Add a guide line: its elements with their faces, how the tool goes on to each, and how it ends at the next; without elements the
    faces that it is for."""
    element = add(parent, "guide", kind=chain.kind.value, closed=text_of(chain.closed))
    if not chain.on:
        for tag in chain.faces:
            add(element, "face", tag=str(tag))
    for word, face, link, _ in chain.elements():
        words = {"move": word}
        if face:
            words["face"] = str(face)
        if link is not None:
            words["link"] = link.value
        add(element, "element", **words)
