"""A real browser without a screen, and the eyes and hands the stories of the page need."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect, sync_playwright

ARGUMENTS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update",
    "--disable-sync", "--disable-quic", "--no-first-run",
]  # fmt: skip
PATIENCE = 60_000  # milliseconds: compiled loops may have to be compiled first


@contextmanager
def browsing() -> Iterator[Browser]:
    """A browser; the story is skipped where none is installed."""
    with sync_playwright() as playwright:
        own = Path(playwright.chromium.executable_path)
        found = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
        if found is None and not own.exists():
            pytest.skip("no Chromium: apt-get install chromium, or playwright install chromium")
        browser = playwright.chromium.launch(executable_path=found or str(own), args=ARGUMENTS)
        yield browser
        browser.close()


def finished(page: Page) -> None:
    """Wait until the run shown is merged or failed, and painted."""
    expect(page.locator("#progress")).to_be_hidden(timeout=PATIENCE)
    painted(page)


def painted(page: Page) -> None:
    """Wait until the picture is up to date."""
    for _ in range(200):
        page.wait_for_timeout(30)
        if not page.evaluate("roomsketch.painter.busy || roomsketch.version !== roomsketch.book.version"):
            page.wait_for_timeout(30)
            return
    raise AssertionError("the picture is never done")


def picture(page: Page) -> str:
    """What the canvas of the scene shows, as text to be compared."""
    painted(page)
    told: str = page.evaluate("document.querySelector('#scene').toDataURL()")
    return told


def spot(page: Page, x: float, y: float) -> tuple[float, float]:
    """Where a place of the room is on the screen."""
    left, top = page.evaluate("([x, y]) => roomsketch.camera.toScreen(x, y)", [x, y])
    box = page.locator("#map").bounding_box()
    assert box is not None
    return box["x"] + left, box["y"] + top


def click_at(page: Page, x: float, y: float) -> None:
    """Click on a place of the room."""
    page.mouse.click(*spot(page, x, y))
