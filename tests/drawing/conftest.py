"""A browser for the pages that are drawn, and what it hears."""

import shutil

import pytest

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
FLAGS = (
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--no-first-run",
)  # fmt: skip


@pytest.fixture(scope="module")
def browser():
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    if CHROMIUM is None:
        pytest.skip("no chromium on this machine")
    with playwright.sync_playwright() as driver:
        opened = driver.chromium.launch(executable_path=CHROMIUM, args=list(FLAGS))
        yield opened
        opened.close()


@pytest.fixture
def visit(browser, tmp_path):
    """Open a file or HTML; in the end nothing was complained about and no host was asked."""
    contexts, heard = [], Heard()

    def opened(shown, **context):
        path = shown
        if isinstance(shown, str):
            path = tmp_path / f"page{len(contexts)}.html"
            path.write_text(shown, encoding="utf-8")
        contexts.append(browser.new_context(**context))
        return heard.page(contexts[-1], path)

    yield opened
    for context in contexts:
        context.close()
    heard.check()


class Heard:
    """What pages complained about and asked for."""

    def __init__(self):
        self.said, self.asked = [], []

    def page(self, context, path):
        page = context.new_page()
        page.set_default_timeout(10_000)
        page.on("console", lambda message: self.said.append(message.text))
        page.on("pageerror", lambda error: self.said.append(str(error)))
        page.on("request", lambda request: self.asked.append(request.url))
        page.goto(path.as_uri())
        return page

    def check(self):
        assert self.said == []
        assert self.asked
        assert [url for url in self.asked if not url.startswith(("file:", "data:"))] == []
