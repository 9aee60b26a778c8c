"""`ossa view` and `ossa track --view`: /skeletons as a browser's EventSource reads it."""
import http.client
import json
import subprocess
import unittest

import receivers
from receivers import BUILD, SOURCE

ONE = SOURCE / "tests" / "golden" / "clips" / "one"


def start(*arguments):
    """The command, and the port that it says it is watched at."""
    process = subprocess.Popen([BUILD / "bin" / "ossa", *arguments, "--port", "0"], stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True)
    for line in process.stdout:
        if "http://127.0.0.1:" in line:
            return process, int(line.split("http://127.0.0.1:")[1].split("/")[0])
    raise AssertionError("no address was said")


def allowed_origin(port, origin):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    connection.request("GET", "/skeletons", headers={"Origin": origin})
    return connection.getresponse().getheader("Access-Control-Allow-Origin")


def events(port, count):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    connection.request("GET", "/skeletons")
    response = connection.getresponse()
    assert response.getheader("Content-Type") == "text/event-stream", response.getheaders()
    found = []
    while len(found) < count:
        line = response.readline().decode()
        if line.startswith("data: "):
            found.append(json.loads(line[len("data: "):]))
            assert response.readline() == b"\n", "an event ends with an empty line"
    connection.close()
    return found


class Events(unittest.TestCase):
    def run_and_read(self, *arguments):
        process, port = start(*arguments)
        try:
            return events(port, 5)
        finally:
            process.terminate()
            process.wait(timeout=20)
            process.stdout.close()

    def check(self, frames):
        numbers = [frame["frame"] for frame in frames]
        self.assertEqual(len(set(numbers)), len(numbers))
        self.assertTrue(any(frame["bodies"] for frame in frames))
        body = next(frame for frame in frames if frame["bodies"])["bodies"][0]
        self.assertEqual(len(body["joints"]["HandLeft"]["p"]), 3)

    def test_view_sends_events_of_a_source(self):
        self.check(self.run_and_read("view", str(ONE)))

    def test_view_sends_events_of_a_camera(self):
        self.check(self.run_and_read("track", f"openni:ossa://{ONE}?loop=1", "--view", "--quiet"))

    def test_events_of_a_source_are_lines_of_the_skeleton_file_without_lag(self):
        receivers.track(ONE, receivers.WORK / "one.jsonl", options=["--lag", "0"])
        frames = receivers.frames_of(receivers.WORK / "one.jsonl")
        for event in self.run_and_read("view", str(ONE)):
            self.assertEqual(event, frames[event["frame"]])

    def test_pages_of_this_machine_can_read_events(self):
        process, port = start("view", str(ONE))
        try:
            self.assertEqual(allowed_origin(port, "http://localhost:3000"), "http://localhost:3000")
            self.assertIsNone(allowed_origin(port, "http://localhost.example.org"))
        finally:
            process.terminate()
            process.wait(timeout=20)
            process.stdout.close()


if __name__ == "__main__":
    receivers.main()
