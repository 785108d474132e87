"""Opens reports from file:// in headless Chromium and tries their player.

Speaks the WebDriver protocol to chromedriver with the standard library alone.
Set GRAINFLOW_SCREENSHOTS=DIR to keep pictures of every whole page, wide and narrow.
"""

import base64
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request

# Pixels of the canvas that are not paper, and a checksum of all of them.
CANVAS = """
const canvas = document.getElementById('grains');
const copy = document.createElement('canvas');
copy.width = canvas.width;
copy.height = canvas.height;
const pen = copy.getContext('2d', { willReadFrequently: true });
pen.drawImage(canvas, 0, 0);
const pixels = pen.getImageData(0, 0, copy.width, copy.height).data;
let drawn = 0, sum = 0;
for (let k = 0; k < pixels.length; k += 4) {
  if (Math.abs(pixels[k] - 0xf7) + Math.abs(pixels[k + 1] - 0xf5) + Math.abs(pixels[k + 2] - 0xf0) > 30) drawn++;
  sum = (sum * 31 + pixels[k] + 3 * pixels[k + 1] + 7 * pixels[k + 2]) % 1000000007;
}
return { drawn, sum };
"""
SCRUB = """
const scrub = document.getElementById('scrub');
scrub.value = arguments[0];
scrub.dispatchEvent(new Event('input', { bubbles: true }));
"""
# Windows in which pages are looked at [pixel].
SIZES = {"wide": (1160, 1400), "narrow": (420, 900)}
# Everything that sticks out of the page or of its plot, or has no size.
LAYOUT = """
const faults = [];
if (document.documentElement.scrollWidth > document.documentElement.clientWidth) faults.push('the page scrolls sideways');
for (const image of document.images)
  if (!image.complete || image.naturalWidth === 0) faults.push('a broken picture: ' + image.alt);
for (const svg of document.querySelectorAll('svg')) {
  const frame = svg.getBoundingClientRect();
  const texts = [...svg.querySelectorAll('text')].map((text) => [text.textContent, text.getBoundingClientRect()]);
  for (const [text, box] of texts)
    if (box.left < frame.left - 1 || box.right > frame.right + 1 || box.bottom > frame.bottom + 1)
      faults.push('a label sticks out of "' + svg.getAttribute('aria-label') + '": ' + text);
  for (let a = 0; a < texts.length; a++) for (let b = a + 1; b < texts.length; b++) {
    const [p, q] = [texts[a][1], texts[b][1]];
    if (p.left < q.right - 1 && q.left < p.right - 1 && p.top < q.bottom - 3 && q.top < p.bottom - 3)
      faults.push('labels overlap in "' + svg.getAttribute('aria-label') + '": ' + texts[a][0] + ' / ' + texts[b][0]);
  }
}
return faults;
"""


class Browser:
    """A headless Chromium behind chromedriver."""

    def __init__(self, folder, graphics=("--disable-gpu",)):
        # Port 0 lets the system choose; chromedriver prints which one it took.
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, text=True)
        try:
            self.address = self.listening_address()
            self.session = None
            self.session = self.start(folder, graphics)
        except BaseException:
            self.driver.kill()
            raise

    def listening_address(self):
        for line in self.driver.stdout:
            found = re.search(r"successfully on port (\d+)", line)
            if found:
                return f"http://127.0.0.1:{found.group(1)}"
        raise SystemExit("chromedriver ended without a port")

    def start(self, folder, graphics):
        arguments = ["--headless", "--no-sandbox", "--disable-background-networking", "--disable-dev-shm-usage",
                     "--window-size=1160,1400", f"--user-data-dir={folder}", *graphics]
        capabilities = {"alwaysMatch": {"browserName": "chrome", "goog:chromeOptions": {"args": arguments},
                                        "goog:loggingPrefs": {"browser": "ALL"}}}
        return self.send("POST", "/session", {"capabilities": capabilities})["sessionId"]

    def send(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.address + path, data, {"Content-Type": "application/json"}, method=method)
        # No proxy: the driver listens on this machine.
        opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        try:
            with opener.open(request, timeout=90) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise SystemExit(f"chromedriver: {error.read().decode()[:600]}") from error

    def do(self, method, path, body=None):
        return self.send(method, f"/session/{self.session}{path}", body)

    def command(self, name, **parameters):
        """A command of the DevTools protocol."""
        return self.do("POST", "/goog/cdp/execute", {"cmd": name, "params": parameters})

    def resize(self, width, height):
        self.command("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def picture(self):
        """The whole page as PNG, also what lies below the window."""
        answer = self.command("Page.captureScreenshot", format="png", captureBeyondViewport=True)
        return base64.b64decode(answer["data"])

    def run(self, script, *arguments):
        return self.do("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def close(self):
        try:
            self.do("DELETE", "")
        finally:
            self.driver.terminate()
            self.driver.wait(timeout=20)


def require(holds, fault):
    if not holds:
        raise SystemExit(f"FAILED: {fault}")


def check_player(browser):
    last = int(browser.run("return document.getElementById('scrub').max"))
    require(int(browser.run("return document.getElementById('scrub').value")) == last, "the last frame is not shown first")
    final = browser.run(CANVAS)
    require(final["drawn"] > 50, f"the canvas is blank: {final}")
    if last == 0:
        return
    browser.run(SCRUB, str(last // 2))
    middle = browser.run(CANVAS)
    require(middle["sum"] != final["sum"], "the scrubber does not change the picture")
    browser.run(SCRUB, str(last))
    require(browser.run(CANVAS)["sum"] == final["sum"], "the same frame is drawn differently")
    key = "document.getElementById('grains').dispatchEvent(new KeyboardEvent('keydown', { key: arguments[0], cancelable: true }))"
    browser.run(key, "Home")
    require(browser.run("return document.getElementById('scrub').value") == "0", "the Home key does not go to the start")
    browser.run("document.getElementById('play').click()")
    for _ in range(50):
        time.sleep(0.1)
        if browser.run("return document.getElementById('scrub').value") != "0":
            break
    require(browser.run("return document.getElementById('scrub').value") != "0", "the play button does not play")
    browser.run(SCRUB, str(last))


def name_of(path):
    """Reports are all called report.html; their folders are not."""
    return path.resolve().parent.name if path.stem == "report" else path.stem


def check(browser, path):
    browser.resize(*SIZES["wide"])
    browser.do("POST", "/url", {"url": path.resolve().as_uri()})
    if browser.run("return document.getElementById('grains') !== null"):
        check_player(browser)
    folder = os.environ.get("GRAINFLOW_SCREENSHOTS")
    for size, (width, height) in SIZES.items():
        browser.resize(width, height)
        faults = browser.run(LAYOUT)
        require(not faults, f"{path}, {size}: " + "; ".join(faults))
        if folder:
            pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
            pathlib.Path(folder, f"{name_of(path)}-{size}.png").write_bytes(browser.picture())
    errors = [entry["message"] for entry in browser.do("POST", "/se/log", {"type": "browser"})
              if entry["level"] in ("SEVERE", "WARNING")]
    require(not errors, f"the console says {errors}")
    print(f"{path}: works")


def main(paths):
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        browser = Browser(folder)
        try:
            for path in paths:
                require(path.is_file(), f"{path} is not there")
                check(browser, path)
        finally:
            browser.close()


if __name__ == "__main__":
    main([pathlib.Path(argument) for argument in sys.argv[1:]])
