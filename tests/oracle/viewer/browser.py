"""Pages in headless Chromium."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from selenium.webdriver import Chrome, ChromeOptions
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from tests.programs import require_programs

FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
)


@contextmanager
def chromium(profile: Path) -> Iterator[Chrome]:
    """A browser with an empty profile."""
    require_programs("chromium", "chromedriver")
    options = ChromeOptions()
    options.binary_location = shutil.which("chromium") or ""
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    for flag in (*FLAGS, f"--user-data-dir={profile}"):
        options.add_argument(flag)
    driver = Chrome(options=options, service=Service(shutil.which("chromedriver")))
    try:
        yield driver
    finally:
        driver.quit()


def logged(driver: Chrome, kind: str) -> list[str]:
    """The messages of a log since it was read last: of the `browser`'s console, or of its `performance`."""
    return [entry["message"] for entry in driver.get_log(kind)]  # type: ignore[no-untyped-call]


def processor_seconds(driver: Chrome) -> float:
    """The processor time that the driver and all processes below it have used."""
    parent: dict[int, int] = {}
    ticks: dict[int, int] = {}
    for process in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):  # it has ended
            fields = process.read_text().rpartition(")")[2].split()
            parent[int(process.parent.name)] = int(fields[1])
            ticks[int(process.parent.name)] = int(fields[11]) + int(fields[12])
    family = {driver.service.process.pid}
    while more := {child for child, of in parent.items() if of in family} - family:
        family |= more
    return sum(ticks.get(process, 0) for process in family) / os.sysconf("SC_CLK_TCK")


class Page:
    """A page that is open, as its user sees it."""

    def __init__(self, driver: Chrome, file: Path, width: int = 1280, height: int = 800) -> None:
        self.driver = driver
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        logged(driver, "browser")
        logged(driver, "performance")
        driver.get(file.as_uri())

    def script(self, body: str, *arguments: object) -> Any:  # noqa: ANN401 - whatever the script returns
        """Run a script in the page."""
        return self.driver.execute_script(body, *arguments)

    def text(self, id: str) -> str:
        """The text of an element."""
        return self.driver.find_element(By.ID, id).text

    @property
    def tick(self) -> str:
        """The tick that the page shows."""
        return self.text("tick")

    def press(self, *keys: str) -> None:
        """Press keys, wherever the focus is."""
        for key in keys:
            ActionChains(self.driver).send_keys(key).perform()

    def click(self, selector: str, text: str = "") -> None:
        """Click the first element that has the text."""
        found = [each for each in self.driver.find_elements(By.CSS_SELECTOR, selector) if text in each.text]
        found[0].click()

    def robots(self) -> dict[str, tuple[float, ...]]:
        """Where the map shows which robots: the names with places and radii in units of the drawing."""
        shown = self.script(
            "const { tracks } = JSON.parse(document.getElementById('scene').textContent);"
            "return viewer.map.poses.map((pose, at) => pose && [tracks[at].label, pose.x, pose.y, pose.radius])"
        )
        return {name: tuple(pose) for name, *pose in filter(None, shown)}

    def number(self, expression: str) -> Any:  # noqa: ANN401 - whatever the expression is
        """The value of an expression of the page, such as `viewer.map.scale`."""
        return self.script(f"return {expression}")

    def count(self, selector: str) -> int:
        """How many elements there are."""
        return len(self.driver.find_elements(By.CSS_SELECTOR, selector))

    def chosen(self, list: str) -> list[str]:
        """The entry chosen in a list."""
        return [each.text for each in self.driver.find_elements(By.CSS_SELECTOR, f"#{list} button.chosen")]
