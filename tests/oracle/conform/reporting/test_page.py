"""The report of conform as a page: whole in one file, with each failure in the viewer, and safe against any text."""

import json
from collections import Counter
from pathlib import Path

from selenium.webdriver.common.by import By
from selenium.webdriver.support.wait import WebDriverWait
from tests.oracle.conform.reporting.test_saving import CASE, FAILURES, ORIGIN
from tests.oracle.viewer.browser import Page, chromium, logged

from carproof.conform.findings import Category, Finding
from carproof.conform.judging.claims import Claims
from carproof.conform.judging.outcome import Outcome
from carproof.conform.reporting.html_report import html_document
from carproof.conform.reporting.saved import save_all
from carproof.conform.run import Options, Report

HOSTILE = "</title><script>document.title = 'taken'</script> & \"<b>"
GONE = Finding(Category.CRASH, "program/alive", f"it is gone {HOSTILE}", f"its last words {HOSTILE}")
PATIENCE = 30


def failing() -> Report:
    options = Options(claims=Claims(frozenset({"paces"})))
    unasked = [Outcome(CASE, skipped="it plans classical grids", asked=False)] * 2
    return Report(options, HOSTILE, [*FAILURES, *unasked], Counter(passed=7), faults=[GONE])


def test_a_browser_shows_every_failure_in_the_viewer_and_fetches_nothing(tmp_path: Path) -> None:
    report = failing()
    file = tmp_path / "report.html"
    file.write_bytes(html_document(report, save_all(report.failures, tmp_path, ORIGIN), ORIGIN))
    with chromium(tmp_path / "profile") as driver:
        shown = Page(driver, file)
        frames = driver.find_elements(By.TAG_NAME, "iframe")
        for frame, rule in zip(frames, ("joint/exchange", "plan/duration"), strict=True):
            shown.script("arguments[0].scrollIntoView()", frame)
            driver.switch_to.frame(frame)
            WebDriverWait(driver, PATIENCE).until(lambda each: each.find_element(By.ID, "tick").text.startswith("tick"))
            assert shown.script("return document.querySelector('h1').textContent") == rule
            assert shown.text("verdict") == "✓ no rule is broken"
            assert shown.count("#robots button") == 2
            driver.switch_to.default_content()
        assert "document.title = 'taken'" in driver.title
        assert logged(driver, "browser") == []
        events = [json.loads(message)["message"] for message in logged(driver, "performance")]
        asked = {
            e["params"]["request"]["url"].partition(":")[0]
            for e in events
            if e["method"] == "Network.requestWillBeSent"
        }
        assert asked <= {"file", "data", "about"}
