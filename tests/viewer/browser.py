"""A headless Chromium that opens the page of `ossa view`, by Selenium: Debian's chromium, chromium-driver, python3-selenium."""
import atexit
import io
import os
import pathlib
import shutil
import subprocess
import sys
import time

BUILD = pathlib.Path(os.environ["OSSA_BUILD"]).resolve()
SOURCE = pathlib.Path(os.environ["OSSA_SOURCE"]).resolve()
WORK = pathlib.Path(os.environ["OSSA_WORK"]).resolve() / "page_test"  # deleted at the start: of this test alone
CLIP = SOURCE / "tests" / "golden" / "clips" / "one"

SKIPPED = 77
try:
    import numpy
    from PIL import Image
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.keys import Keys
except ImportError as missing:
    print(f"skipped: {missing}: python3-selenium, python3-numpy and python3-pil are needed")
    sys.exit(SKIPPED)
CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
if not CHROMIUM or not DRIVER:
    print("skipped: chromium and chromium-driver are not installed")
    sys.exit(SKIPPED)

PATIENCE_S = 60
WINDOW = (1000, 720)  # small, as the picture is computed without a graphics card


class Command:
    """An `ossa` that serves the page, and its address."""

    def __init__(self, *arguments, port=0):
        self.process = subprocess.Popen([BUILD / "bin" / "ossa", *map(str, arguments), "--port", str(port)],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, cwd=WORK)
        atexit.register(self.end)
        for line in self.process.stderr:
            if "watch at " in line:
                self.url = line.split("watch at ")[1].strip()
                return
        raise AssertionError("no address was printed")

    def end(self):
        if self.process.poll() is None:
            self.process.terminate()
            assert self.process.wait(timeout=20) == 0, f"{self.process.args} ended with {self.process.returncode}"
        self.process.stderr.close()


def start_browser():
    options = webdriver.ChromeOptions()
    options.binary_location = CHROMIUM
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--window-size={},{}".format(*WINDOW),
                     "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-extensions", "--mute-audio",
                     "--disable-background-networking", f"--user-data-dir={WORK / 'profile'}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    options.add_experimental_option("prefs", {"download.default_directory": str(WORK / "downloads")})
    driver = webdriver.Chrome(service=Service(DRIVER), options=options)
    driver.set_script_timeout(PATIENCE_S)
    return driver


class Page:
    """The page in the browser, as a person uses it."""

    def __init__(self, driver, url):
        self.driver = driver
        driver.get(url)
        self.wait("return Boolean(window.page && page.frame)", "a first frame")

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def wait(self, script, what):
        until = time.monotonic() + PATIENCE_S
        while time.monotonic() < until:
            found = self.run(script)
            if found:
                return found
            time.sleep(0.05)
        raise AssertionError(f"waited for {what}: {self.run('return document.body.innerText')}")

    def click(self, selector):
        self.driver.find_element("css selector", selector).click()

    def press(self, key):
        self.driver.find_element("css selector", "body").send_keys(key)

    def send(self, key):
        """To what has the focus."""
        self.driver.switch_to.active_element.send_keys(key)

    def wait_for_frame(self, number):
        self.wait(f"return page.frame.number === {number} && page.player.shown === {number}", f"frame {number}")

    def box(self, selector):
        """left, top, width, height on the page, CSS pixels."""
        return self.run("const b = document.querySelector(arguments[0]).getBoundingClientRect();"
                        "return [b.left, b.top, b.width, b.height]", selector)

    def picture(self):
        """What is on the screen: height x width x 3."""
        return numpy.array(Image.open(io.BytesIO(self.driver.get_screenshot_as_png())).convert("RGB")).astype(int)

    def picture_of(self, selector):
        left, top, width, height = map(round, self.box(selector))
        return self.picture()[top:top + height, left:left + width]

    def save(self, name, folder):
        """A screenshot as PNG of 256 colours: a third of the bytes."""
        image = Image.open(io.BytesIO(self.driver.get_screenshot_as_png())).convert("RGB")
        folder.mkdir(parents=True, exist_ok=True)
        image.quantize(256, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE).save(folder / name, optimize=True)

    def console_errors(self):
        return [entry for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]
