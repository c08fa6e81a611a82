"""Opens a report in a browser and checks what only a browser knows.

    python3 tests/browser/check_report.py target/regress/index.html [--screenshots DIR]

For a desk and a telephone, light and dark: no message of error, nothing fetched, no sideways scrolling of the page, every picture with a
size, an alternative text and readable letters, enough contrast, tables that sort by number and by text. Exit 0 when all of it holds.
"""

import argparse
import base64
import pathlib
import sys

from devtools import Browser

VIEWS = [("desk", 1200, 900), ("telephone", 390, 844)]

PICTURES = """[...document.querySelectorAll('svg, img')].map(picture => ({
    width: Number(picture.getAttribute('width')), height: Number(picture.getAttribute('height')),
    alt: (picture.getAttribute('aria-label') || picture.getAttribute('alt') || '').trim(),
    role: picture.tagName === 'IMG' ? 'img' : picture.getAttribute('role'),
    shown: picture.getBoundingClientRect().width, page: document.documentElement.clientWidth,
    letters: Math.min(...[...picture.querySelectorAll('text')].map(t => t.getBoundingClientRect().height)),
}))"""

# WCAG relative luminance of text against the paper.
CONTRAST = """(() => {
    const channel = c => (c /= 255) <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
    const luminance = colour => { const [r, g, b] = colour.match(/[\\d.]+/g).map(Number); return 0.2126 * channel(r) + 0.7152 * channel(g) + 0.0722 * channel(b); };
    const paper = luminance(getComputedStyle(document.body).backgroundColor);
    const ratio = colour => { const [a, b] = [luminance(colour), paper].sort((a, b) => b - a); return (a + 0.05) / (b + 0.05); };
    const marks = [...document.querySelectorAll('svg text')].map(t => getComputedStyle(t).fill);
    const words = [...document.querySelectorAll('p, td, th, dd, dt, a, figcaption')].map(e => getComputedStyle(e).color);
    return Math.min(...new Set([...marks, ...words].map(ratio)));
})()"""

# Clicks every head twice and tells the tables whose column is then not in order.
SORTING = """[...document.querySelectorAll('thead th')].flatMap(head => {
    const column = () => [...head.closest('table').tBodies[0].rows].map(row => row.cells[head.cellIndex]);
    const before = column().length;
    const key = cell => cell.dataset.value ?? cell.textContent.trim();
    const wrong = [];
    for (const direction of ['ascending', 'descending']) {
        head.querySelector('button').click();
        const keys = column().map(key), full = keys.filter(k => k !== '' && k !== '—');
        if (head.getAttribute('aria-sort') !== direction) wrong.push('not marked ' + direction);
        if (keys.length !== before) wrong.push('rows lost');
        if (keys.slice(0, full.length).some(k => k === '' || k === '—')) wrong.push('empty cells not last');
        const numeric = full.every(k => !isNaN(k));
        const order = (a, b) => (direction === 'ascending' ? 1 : -1) * (numeric ? a - b : a.localeCompare(b));
        if (full.some((k, n) => n > 0 && order(full[n - 1], k) > 0)) wrong.push('not ' + direction);
    }
    return wrong.map(fault => head.textContent + ': ' + fault);
})"""


def faults_of(browser):
    """What is wrong with the page that is open."""
    overflow = browser.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
    if overflow > 0:
        yield f"the page is {overflow} px wider than the window"

    pictures = browser.evaluate(PICTURES)
    if not pictures:
        yield "no picture at all"
    for picture in pictures:
        if not (picture["width"] > 0 and picture["height"] > 0):
            yield f"a picture without a size: {picture}"
        if picture["role"] != "img" or not picture["alt"]:
            yield f"a picture without an alternative text: {picture}"
        if picture["shown"] > picture["page"]:
            yield f"a picture wider than the page: {picture}"
        # Line boxes: letters of 8 px stand in lines of about 9.
        if picture["letters"] is not None and picture["letters"] < 9:
            yield f"letters of {picture['letters']:.1f} px: {picture['alt']}"

    contrast = browser.evaluate(CONTRAST)
    if contrast < 4.5:
        yield f"contrast {contrast:.2f} : 1, WCAG AA wants 4.5"
    if not browser.evaluate("document.querySelectorAll('thead th button').length"):
        yield "no table that sorts"
    yield from browser.evaluate(SORTING)

    # Last, so that it hears what the clicks brought about.
    for event in browser.events:
        method, body = event["method"], event["params"]
        if method == "Runtime.exceptionThrown":
            yield f"exception: {body['exceptionDetails']['text']}"
        if method == "Runtime.consoleAPICalled" and body["type"] in ("error", "assert", "warning"):
            yield f"console: {body['args']}"
        if method == "Log.entryAdded" and body["entry"]["level"] in ("error", "warning"):
            yield f"log: {body['entry']['text']}"
        if method == "Network.requestWillBeSent" and not body["request"]["url"].startswith(("file:", "data:")):
            yield f"fetches {body['request']['url']}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--screenshots", type=pathlib.Path, help="folder for a picture of each view")
    options = parser.parse_args()
    if not options.page.is_file():
        raise SystemExit(f"no page at {options.page}")

    n_passed = n_failed = 0
    with Browser() as browser:
        for name, width, height in VIEWS:
            for scheme in ("light", "dark"):
                browser.open(options.page.resolve().as_uri(), width, height, scheme, mobile=name == "telephone")
                if options.screenshots:
                    options.screenshots.mkdir(parents=True, exist_ok=True)
                    shot = browser.call("Page.captureScreenshot", captureBeyondViewport=True, clip=clip(width))
                    (options.screenshots / f"{name}-{scheme}.png").write_bytes(base64.b64decode(shot["data"]))
                faults = list(faults_of(browser))
                for fault in faults:
                    print(f"{name}, {scheme}: {fault}")
                n_failed += bool(faults)
                n_passed += not faults
    print(f"{n_passed} passed, {n_failed} failed")
    sys.exit(n_failed > 0)


def clip(width):
    """The upper part of the page: enough to see one run whole."""
    return {"x": 0, "y": 0, "width": width, "height": 3000, "scale": 1}


if __name__ == "__main__":
    main()
