"""The page of a batch: counts, links that lead somewhere, reasons grouped, nothing from the net."""

from __future__ import annotations

import re

from lxml import html

from trunnion.model.part_result import PartResult
from trunnion.report.batch_page import batch_page, rejections

PASSED = PartResult(
    part="in/a & b.step",
    folder="a & b",
    verdict="passed",
    family="panel",
    coverage=1.0,
    reachable=1.0,
    gouge=0.0,
    machining_time_s=61.0,
    seconds=9.0,
    memory=900.0,
    files=("a & b.S1.nc", "a & b.features.png", "a & b.report.html"),
)
FAILED = PartResult(
    part="in/rib.step",
    folder="rib",
    verdict="failed",
    coverage=0.98765,
    reachable=0.99,
    gouge=0.25,
    machining_time_s=30.0,
    note="verify.gouge: 0.25 mm into face 3; and 2 more",
    reasons={"verify.gouge": 2, "verify.collision": 1},
    files=("rib.report.html",),
)
CRASHED = PartResult(
    part="in/<x>.step",
    folder="x",
    verdict="crashed",
    note="its process was ended by SIGSEGV",
    files=("crash.txt",),
)
RESULTS = (PASSED, FAILED, CRASHED, FAILED)


def page_of(results, n_parts):
    return html.fromstring(batch_page(results, n_parts))


def test_it_says_how_many_are_released_and_done():
    page = page_of(RESULTS, 6)
    assert page.findtext(".//h1") == "1 of 6 parts released"
    assert page.findtext(".//p").strip() == "4 of 6 done · 1 crashed · 2 failed · 1 passed"
    assert "25.00 %" in page.text_content()


def test_each_part_has_a_row_with_its_figures():
    rows = page_of(RESULTS, 4).xpath("//table[@id='parts']/tbody/tr")
    assert len(rows) == 4
    cells = [cell.text_content().strip() for cell in rows[1].iterfind("td")]
    assert cells[3:9] == ["failed", "98.76 %", "99.00 %", "0.2500", "0 min 30 s", "0 min 00 s"]
    assert cells[-1] == FAILED.note


def test_reports_and_pictures_are_linked_by_addresses_that_lead_there():
    page = page_of([PASSED], 1)
    (picture,) = page.xpath("//img/@src")
    assert picture == "a%20%26%20b/a%20%26%20b.features.png"
    assert set(page.xpath("//a/@href")) == {"a%20%26%20b/a%20%26%20b.report.html"}


def test_a_crash_links_its_last_words():
    assert page_of([CRASHED], 1).xpath("//a/@href") == ["x/crash.txt"]


def test_names_are_text_and_no_markup():
    assert "in/<x>.step" in page_of([CRASHED], 1).text_content()


def test_columns_are_sorted_by_numbers_that_rows_carry():
    row = page_of([FAILED], 1).xpath("//table[@id='parts']/tbody/tr")[0]
    assert row.xpath("td[5]/@data-key") == ["0.98765"]
    heads = page_of([FAILED], 1).xpath("//table[@id='parts']//th")
    assert len(heads) == len(row.xpath("td"))


def test_reasons_are_those_of_most_parts_first():
    first, *rest = rejections(RESULTS)
    assert (first.code, first.n_findings, len(first.parts)) == ("verify.collision", 2, 2)
    assert [(r.code, r.n_findings) for r in rest] == [("verify.gouge", 4), ("crashed", 1)]


def test_nothing_comes_from_the_net():
    text = batch_page(RESULTS, 4)
    assert not re.search(r"(?:src|href)=\"(?:https?:)?//|@import|url\(", text)


def test_before_the_first_part_is_done_there_is_a_page_too():
    assert page_of([], 3).findtext(".//h1") == "0 of 3 parts released"
