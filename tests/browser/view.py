"""Opens logs with `grainflow view` in headless Chromium and works the page: view.py GRAINFLOW LOG [LOG2].

With WebGL2 (by software) and without; served, side by side, and as an exported page. Speaks to chromedriver as report.py
does, and keeps pictures where GRAINFLOW_SCREENSHOTS says.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from report import LAYOUT, SCRUB, SIZES, Browser, require

SOFTWARE_WEBGL = ["--enable-unsafe-swiftshader", "--use-angle=swiftshader"]
NO_WEBGL = ["--disable-gpu", "--disable-3d-apis"]
# Pixels of the grains of pane N that are not transparent, and a checksum of all of them.
GRAINS = """
const pane = arguments[0];
// What was asked for is drawn with the next picture.
return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))).then(() => {
const canvas = document.querySelectorAll('.stage .grains')[pane];
const copy = document.createElement('canvas');
copy.width = canvas.width;
copy.height = canvas.height;
const pen = copy.getContext('2d', { willReadFrequently: true });
pen.drawImage(canvas, 0, 0);
const pixels = pen.getImageData(0, 0, copy.width, copy.height).data;
let drawn = 0, sum = 0;
for (let k = 0; k < pixels.length; k += 4) {
  if (pixels[k + 3] > 30) drawn++;
  sum = (sum * 31 + pixels[k] + 3 * pixels[k + 1] + 7 * pixels[k + 2]) % 1000000007;
}
return { drawn, sum };
});
"""
PLOTS = "return [...document.querySelectorAll('.plot canvas')].map((canvas) => [canvas.getAttribute('aria-label'), canvas.toDataURL()].join())"
MOMENTS = "return [...document.querySelectorAll('.state > span')].map((span) => span.textContent)"
VALUE = "return Number(document.getElementById('scrub').value)"
KEY = "document.querySelector('.stage').dispatchEvent(new KeyboardEvent('keydown', { key: arguments[0], shiftKey: arguments[1] || false, cancelable: true, bubbles: true }))"
CHOOSE = """
const list = document.getElementById(arguments[0]);
list.value = arguments[1];
list.dispatchEvent(new Event('change', { bubbles: true }));
"""
NAMELESS = """
return [...document.querySelectorAll('button, input, select, canvas[tabindex], .stage')].filter((one) =>
  !one.getAttribute('aria-label') && !one.textContent.trim() && !one.labels?.length).map((one) => one.outerHTML);
"""


class Server:
    """`grainflow view`, until it is closed."""

    def __init__(self, program, logs):
        self.process = subprocess.Popen([program, "view", "--no-browser", *logs], stdout=subprocess.PIPE, text=True)
        line = self.process.stdout.readline()
        found = re.search(r"http://127\.0\.0\.1:\d+/\?token=[0-9a-f]+", line)
        require(found, f"no address in {line!r}")
        self.address = found.group(0)

    def close(self):
        self.process.terminate()
        require(self.process.wait(timeout=20) == 0, "the server does not end with 0")


def until(browser, script, holds, fault, *arguments):
    """What `script` gives, as soon as it `holds`."""
    for _ in range(100):
        found = browser.run(script, *arguments)
        if holds(found):
            return found
        time.sleep(0.1)
    raise SystemExit(f"FAILED: {fault}; the page says {browser.run(MOMENTS)}, {found if len(str(found)) < 200 else ''}")


def check_time(browser, panes):
    """Scrubber, keys and player, and what follows them."""
    last = int(browser.run("return document.getElementById('scrub').max"))
    require(last > 3, f"{last + 1} frames are too few to try the page")
    final = [until(browser, GRAINS, lambda one: one["drawn"] > 50, f"pane {pane} shows no grains", pane) for pane in range(panes)]
    require(browser.run(VALUE) == last, "the last frame is not shown first")
    plots = until(browser, PLOTS, lambda each: len(each) > 0 and "–" not in each[0], "there are no plots")
    browser.run(SCRUB, str(last // 2))
    for pane in range(panes):
        until(browser, GRAINS, lambda one: one["sum"] != final[pane]["sum"] and one["drawn"] > 50, "the scrubber moves no grains", pane)
    until(browser, PLOTS, lambda each: all(a != b for a, b in zip(each, plots)), "the plots do not follow")
    browser.run(KEY, "End")
    for pane in range(panes):
        until(browser, GRAINS, lambda one: one["sum"] == final[pane]["sum"], "the same frame is drawn differently", pane)
    browser.run(KEY, "ArrowLeft")
    require(browser.run(VALUE) == last - 1, "an arrow key does not step")
    browser.run(KEY, "Home")
    require(browser.run(VALUE) == 0, "the Home key does not go to the start")
    browser.run(KEY, " ")
    until(browser, VALUE, lambda value: value > 1, "the space bar does not play")
    browser.run("document.getElementById('play').click()")
    paused = browser.run(VALUE)
    time.sleep(0.5)
    require(browser.run(VALUE) == paused, "the player does not pause")
    seek = """
const canvas = document.querySelector('.plot canvas'), box = canvas.getBoundingClientRect();
canvas.dispatchEvent(new MouseEvent('pointerdown', { clientX: box.right - 12, clientY: box.top + 40, bubbles: true }));
"""
    browser.run("Element.prototype.setPointerCapture = () => {};" + seek)
    require(browser.run(VALUE) > 0.8 * last, "a click into a plot does not go there")
    browser.run(KEY, "End")


def check_looks(browser):
    """Colours, zoom, turning."""
    before = until(browser, GRAINS, lambda one: one["drawn"] > 50, "no grains", 0)
    offered = browser.run("return [...document.getElementById('colour').options].filter((one) => !one.disabled).map((one) => one.value)")
    for colour in offered[1:]:
        browser.run(CHOOSE, "colour", colour)
        until(browser, GRAINS, lambda one: one["sum"] != before["sum"] and one["drawn"] > 50, f"{colour} colours nothing", 0)
        until(browser, "return document.querySelector('.colours em').textContent", lambda text: "speed" not in text, "the legend stays")
    browser.run(CHOOSE, "colour", "speed")
    until(browser, GRAINS, lambda one: one["sum"] == before["sum"], "speed looks different the second time", 0)
    for keys in (["+"], ["ArrowRight", True]):
        browser.run(KEY, *keys)
        until(browser, GRAINS, lambda one: one["sum"] != before["sum"], f"{keys} does nothing", 0)
        browser.run(KEY, "0")
        until(browser, GRAINS, lambda one: one["sum"] == before["sum"], "0 does not show the whole box again", 0)


def check_page(browser, name, panes):
    folder = os.environ.get("GRAINFLOW_SCREENSHOTS")
    nameless = browser.run(NAMELESS)
    require(not nameless, f"{name}: without a label: {nameless}")
    for size, (width, height) in SIZES.items():
        browser.resize(width, height)
        until(browser, GRAINS, lambda one: one["drawn"] > 50, "no grains after a change of size", 0)
        faults = browser.run(LAYOUT)
        require(not faults, f"{name}, {size}: " + "; ".join(faults))
        if folder:
            pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
            pathlib.Path(folder, f"view-{name}-{size}.png").write_bytes(browser.picture())
    errors = [entry["message"] for entry in browser.do("POST", "/se/log", {"type": "browser"})
              if entry["level"] in ("SEVERE", "WARNING") and "GPU stall" not in entry["message"]]
    require(not errors, f"{name}: the console says {errors}")
    print(f"view {name}: works")


def open_page(browser, address):
    browser.resize(*SIZES["wide"])
    browser.do("POST", "/url", {"url": address})


def check_with_webgl(program, log, other, folder):
    browser = Browser(folder, SOFTWARE_WEBGL)
    try:
        server = Server(program, [log])
        open_page(browser, server.address)
        check_time(browser, 1)
        require("WebGL" not in browser.run("return document.getElementById('notes').textContent"), "WebGL is missed")
        check_looks(browser)
        check_page(browser, f"{pathlib.Path(log).name}", 1)
        server.close()
        server = Server(program, [log, other])
        open_page(browser, server.address)
        check_time(browser, 2)
        browser.run(CHOOSE, "step", "collisions")
        until(browser, "return document.getElementById('clock').textContent", lambda text: "collisions" in text, "no steps by collisions")
        check_page(browser, f"{pathlib.Path(log).name}-two", 2)
        server.close()
        page = pathlib.Path(folder, "page.html")
        subprocess.run([program, "view", log, "--export", page], check=True)
        open_page(browser, page.resolve().as_uri())
        check_time(browser, 1)
        check_looks(browser)
        check_page(browser, f"{pathlib.Path(log).name}-exported", 1)
    finally:
        browser.close()


def check_without_webgl(program, log, folder):
    browser = Browser(folder, NO_WEBGL)
    try:
        server = Server(program, [log])
        open_page(browser, server.address)
        check_time(browser, 1)
        notes = browser.run("return document.getElementById('notes').textContent")
        require("no WebGL2" in notes, f"it is not said that WebGL is missing: {notes}")
        check_looks(browser)
        server.close()
        print("view without WebGL: works")
    finally:
        browser.close()


def main(program, log, other):
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        check_with_webgl(program, log, other, folder)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        check_without_webgl(program, log, folder)


if __name__ == "__main__":
    arguments = sys.argv[1:]
    main(arguments[0], arguments[1], arguments[-1])
