"""The page as people use it, in a real browser: a map that grows, is looked into, planned on and taken away."""

import gzip
import json
import re
from base64 import b64encode
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser, Page, expect

from slam.room_file import read_room
from slam.serve.downloads import DOWNLOADS
from tests.stories.chromium import PATIENCE, browsing, click_at, finished, painted, picture, spot
from tests.stories.served import serving

DATASETS = Path(__file__).parents[2] / "datasets"
BALLAST = b"# nothing to read here\n" * 20_000  # so that sending takes a while
SCANS = 10  # of the flat: a small piece, so that it is merged while one watches

# Puts files on the page as a drag from the desktop does.
DROP = """files => {
  const carried = new DataTransfer();
  for (const [name, content] of files)
    carried.items.add(new File([Uint8Array.from(atob(content), letter => letter.charCodeAt(0))], name));
  for (const type of ["dragenter", "dragover", "drop"]) {
    const event = new DragEvent(type, { dataTransfer: carried, bubbles: true, cancelable: true });
    document.querySelector("main").dispatchEvent(event);
  }
}"""
# Notes what the page says of its progress, frame by frame.
WATCH = """() => {
  const seen = new Set();
  window.watched = seen;
  const look = () => {
    const sending = document.querySelector("#sending");
    if (!sending.hidden) seen.add(`sending ${document.querySelector("#sending-progress").value}`);
    seen.add(`${document.querySelector("#state").textContent} / ${document.querySelector("#map").ariaLabel}`);
    requestAnimationFrame(look);
  };
  look();
}"""


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with browsing() as browser:
        yield browser


@pytest.fixture(scope="module")
def address(browser: Browser) -> Iterator[str]:
    with serving(DATASETS / "flynn_basement") as served:
        yield served.address


@pytest.fixture
def page(browser: Browser, address: str) -> Iterator[Page]:
    """The basement, merged, on a page that nobody has touched yet; a fault in a script fails the story."""
    with browser.new_context(viewport={"width": 1200, "height": 760}) as context:
        page = opened(context.new_page(), address)
        faults: list[str] = []
        page.on("pageerror", lambda fault: faults.append(str(fault)))
        yield page
        assert faults == []


def opened(page: Page, address: str) -> Page:
    page.goto(address)
    page.locator("#runs").select_option("1")
    finished(page)
    return page


def drop(page: Page, files: dict[str, bytes]) -> None:
    page.evaluate(DROP, [[name, b64encode(content).decode()] for name, content in files.items()])


def piece_of_a_flat() -> dict[str, bytes]:
    folder = DATASETS / "apartment_lidar"
    lines = gzip.decompress((folder / "readings.csv.gz").read_bytes()).splitlines(keepends=True)
    return {
        "recording.toml": (folder / "recording.toml").read_bytes().replace(b"readings.csv.gz", b"readings.csv"),
        "readings.csv": b"".join(lines[: SCANS + 1]) + BALLAST,
    }


def saved(page: Page, name: str) -> Path:
    page.get_by_role("tab", name="Save").click()
    with page.expect_download(timeout=PATIENCE) as download:
        page.get_by_role("button", name=f"Save {DOWNLOADS[name].file}").click()
    return download.value.path()


def test_a_dropped_recording_is_sent_with_progress_and_its_map_grows_scan_by_scan(page: Page) -> None:
    slow = page.context.new_cdp_session(page)
    slow.send("Network.enable")
    slow.send(
        "Network.emulateNetworkConditions",
        {"offline": False, "latency": 0, "downloadThroughput": -1, "uploadThroughput": 300_000},
    )
    page.evaluate(WATCH)
    drop(page, piece_of_a_flat())
    expect(page.locator("#sending")).to_be_visible()
    expect(page.locator("#state")).to_contain_text(f"of {SCANS}", timeout=PATIENCE)
    expect(page.locator("#state")).to_contain_text(f"{SCANS} scans", timeout=PATIENCE)
    seen = page.evaluate("[...watched]")
    shares = {float(told.split()[1]) for told in seen if told.startswith("sending")}
    grown = {int(found.group(1)) for told in seen if (found := re.search(rf"scan (\d+) of {SCANS}", told))}
    maps = {told.split(" / ")[1] for told in seen if "Room map of" in told}
    assert any(0 < share < 1 for share in shares)
    assert len(grown - {0, SCANS}) >= 2
    assert len(maps) >= 3  # what had been merged so far was shown before the end
    assert page.locator("#runs option").count() >= 2


def test_a_recording_that_cannot_be_merged_says_why_and_the_page_goes_on(page: Page) -> None:
    drop(page, {"my drive.csv": b"time,x,y,heading,range@0\n1,2,3\n"})
    expect(page.locator("#failure")).to_be_visible(timeout=PATIENCE)
    expect(page.locator("#failure-reason")).to_contain_text("my_drive.csv line 2: 3 fields, but the header has 5")
    expect(page.locator("#state")).to_contain_text("failed")
    page.keyboard.press("Escape")
    expect(page.locator("#failure")).to_be_hidden()
    page.locator("#runs").select_option("1")
    expect(page.locator("#state")).to_contain_text("3 scans")


def test_what_is_no_recording_is_refused_before_anything_is_done(page: Page) -> None:
    drop(page, {"notes.pdf": b"%PDF"})
    expect(page.locator("#failure-reason")).to_contain_text("notes.pdf is no recording: known endings are .log, .csv")


def test_the_time_slider_shows_what_was_known_after_each_scan(page: Page) -> None:
    end = picture(page)
    slider = page.get_by_role("slider", name="Scans shown")
    slider.focus()
    page.keyboard.press("Home")
    expect(page.locator("#moment")).to_contain_text("scan 1 of 3")
    first = picture(page)
    assert first != end
    page.keyboard.press("ArrowRight")
    expect(page.locator("#moment")).to_contain_text("scan 2 of 3")
    assert picture(page) not in {first, end}
    page.get_by_role("button", name="Play").click()
    expect(page.locator("#moment")).to_contain_text("scan 3 of 3")
    expect(page.get_by_role("button", name="Play")).to_be_visible()
    assert picture(page) == end


def test_every_layer_goes_on_and_off_alone(page: Page) -> None:
    rows = page.locator("#layer-list label")
    assert rows.count() == 14
    for row in rows.all():
        before, nothing_there = picture(page), row.locator("output").text_content() == "none"
        row.click()
        assert (picture(page) == before) is nothing_there, row.text_content()
        row.click()
        assert picture(page) == before, row.text_content()
    assert rows.filter(has_text="none").count() <= 2


def test_the_map_is_panned_and_zoomed_by_hand_and_by_keys(page: Page) -> None:
    page.locator("#map").focus()
    seen = [picture(page)]

    def changed() -> bool:
        seen.append(picture(page))
        return seen[-1] != seen[-2]

    for key in ("ArrowLeft", "ArrowDown", "+", "-"):
        page.keyboard.press(key)
        assert changed(), key
    x, y = spot(page, 0, 0)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60, y + 40, steps=4)
    page.mouse.up()
    assert changed()
    page.mouse.wheel(0, -300)
    assert changed()
    page.keyboard.press("f")
    assert picture(page) == seen[0]


def test_an_edge_under_the_pointer_tells_its_provenance(page: Page) -> None:
    room = read_room(saved(page, "geojson"))
    edge = max(room.edges, key=lambda edge: np.hypot(*np.subtract(edge.end, edge.start)) * (edge.support > 1))
    page.mouse.move(*spot(page, *np.add(edge.start, edge.end) / 2))
    tip = page.get_by_role("tooltip")
    expect(tip).to_contain_text("Wall face")
    expect(tip).to_contain_text(f"{len(edge.views)} of 3 views")
    expect(tip).to_contain_text(re.compile("contradicted(never|[0-9]+ times?)"))
    page.mouse.move(*spot(page, 0, 0))
    expect(tip).to_be_hidden()


def test_both_planners_answer_side_by_side_and_say_why_where_they_fail(page: Page) -> None:
    page.get_by_role("tab", name="Plan").click()
    click_at(page, 0, 0)
    click_at(page, 1.5, -2.5)
    cards = page.locator(".answer")
    expect(cards.locator(".verdict")).to_have_text(["path found", "path found"], timeout=PATIENCE)
    for card in (cards.nth(0), cards.nth(1)):
        for what in ("length", "clearance", "time"):
            expect(card.locator("dt")).to_contain_text([what])
    boxes = [card.bounding_box() for card in (cards.nth(0), cards.nth(1))]
    assert boxes[0] is not None
    assert boxes[1] is not None
    assert boxes[0]["y"] == boxes[1]["y"]
    page.get_by_label("radius").fill("1.9")
    page.get_by_label("radius").press("Tab")
    expect(cards.locator(".verdict.no")).to_have_count(2, timeout=PATIENCE)
    expect(cards.nth(1).locator("p.no").last).to_contain_text(re.compile(r"\d"))
    page.get_by_label("Shape of the robot").select_option("rectangle")
    expect(cards.locator(".verdict")).to_have_text(["path found", "path found"], timeout=PATIENCE)


def test_the_map_can_be_taken_away_in_every_format(page: Page) -> None:
    for name in DOWNLOADS:
        assert saved(page, name).stat().st_size > 100, name
        expect(page.locator("#save-hint")).to_contain_text("is saved")


def test_the_page_works_without_a_mouse(page: Page) -> None:
    page.keyboard.press("Tab")
    expect(page.get_by_role("link", name="Skip to the map")).to_be_focused()
    page.keyboard.press("Enter")
    expect(page.locator("#map")).to_be_focused()
    page.keyboard.press("n")
    expect(page.get_by_role("tooltip")).to_contain_text("views")
    expect(page.locator("#voice")).to_contain_text("views")
    page.keyboard.press("Escape")
    page.keyboard.press("f")
    page.keyboard.press("s")
    expect(page.locator("#start-at")).not_to_have_text("not yet")
    page.locator("#map").focus()
    for _ in range(2):
        page.keyboard.press("ArrowDown")
    page.keyboard.press("g")
    expect(page.locator(".answer dl")).to_have_count(2, timeout=PATIENCE)
    page.keyboard.press("l")
    expect(page.locator("#layer-free")).to_be_focused()
    page.keyboard.press("?")
    expect(page.get_by_role("dialog")).to_be_visible()
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog")).to_be_hidden()


def test_everything_fits_and_answers_taps_on_a_phone(browser: Browser, address: str) -> None:
    with browser.new_context(
        viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True, device_scale_factor=2
    ) as context:
        page = opened(context.new_page(), address)
        assert page.evaluate("document.documentElement.scrollWidth") == 390
        for name in ("Layers", "Plan", "Run", "Save"):
            page.get_by_role("tab", name=name).tap()
            expect(page.get_by_role("tabpanel", name=name)).to_be_visible()
        page.get_by_role("tab", name="Plan").tap()
        for place in ((0, 0), (1.5, -2.5)):
            page.touchscreen.tap(*spot(page, *place))
        expect(page.locator(".answer .verdict")).to_have_text(["path found", "path found"], timeout=PATIENCE)
        assert page.evaluate("document.documentElement.scrollWidth") == 390


def test_the_picture_follows_the_system_into_the_dark(page: Page) -> None:
    light, paper = picture(page), "getComputedStyle(document.body).backgroundColor"
    day = page.evaluate(paper)
    page.emulate_media(color_scheme="dark")
    assert page.evaluate(paper) != day
    painted(page)
    assert picture(page) != light


def test_truth_is_shown_beside_the_map_with_its_errors(page: Page) -> None:
    page.get_by_role("tab", name="Run").click()
    expect(page.get_by_role("tabpanel", name="Run")).to_contain_text("Against the truth")
    report = json.loads(saved(page, "report").read_text())
    assert report["counts"]["scans"] == 3
