"""A program that answers `start` as it must and then does what its argument says; with `--at-start` at once.

Run it with `python -IS`: it imports nothing that takes time.
"""

import json
import os
import sys
import time
from typing import Any

NAME = {"name": "hostile", "version": "1", "ops": ["start", "check", "query", "plan", "stop"]}
FOR_EVER = 10**6
HIDDEN = ("PYTEST_", "HYPOTHESIS_", "CARPROOF_")


def write(data: bytes) -> None:
    try:
        while data:
            data = data[os.write(1, data) :]
    except BrokenPipeError:
        sys.exit(1)


def respond(request: dict[str, Any], **fields: object) -> None:
    write(json.dumps({"id": request["id"], **fields}).encode() + b"\n")


def drip(request: dict[str, Any]) -> None:
    for byte in json.dumps({"id": request["id"], "result": {"plan": None}, "padding": "x" * FOR_EVER}).encode():
        write(bytes([byte]))
        time.sleep(0.05)


def endless(data: bytes) -> None:
    while True:
        write(data)


def exhaust_memory() -> None:
    kept = []
    while True:
        kept.append(bytearray(2**24))


def leave_a_child_behind() -> None:
    if os.fork() == 0:
        time.sleep(FOR_EVER)
    os._exit(3)


def flood_standard_error() -> None:
    while True:
        os.write(2, b"e" * 65536)


def complain_and_exit() -> None:
    os.write(2, b"out of robots\n")
    os._exit(3)


def answer_half() -> None:
    write(b'{"id": 1, "res')
    os._exit(0)


def close_output() -> None:
    os.close(1)
    time.sleep(FOR_EVER)


FIELDS: dict[str, dict[str, Any]] = {
    "unknown field": {"result": {"plan": None, "cost": 1}},
    "skips everything": {"skipped": "no time"},
    "environment": {"skipped": " ".join(name for name in os.environ if name.startswith(HIDDEN)) or "nothing visible"},
}
ACTS = {
    "random bytes": lambda: write(os.urandom(300).replace(b"\n", b"") + b"\n"),
    "endless output": lambda: endless(b"x" * 65536),
    "endless lines": lambda: endless(b"{}\n" * 1000),
    "endless standard error": flood_standard_error,
    "silence": lambda: time.sleep(FOR_EVER),
    "exit": complain_and_exit,
    "killed": lambda: os.kill(os.getpid(), 11),
    "half an answer": answer_half,
    "closed output": close_output,
    "memory": exhaust_memory,
    "child left behind": leave_a_child_behind,
}


def misbehave(how: str, request: dict[str, Any]) -> None:
    if how in FIELDS:
        respond(request, **FIELDS[how])
    elif how == "slow drip":
        drip(request)
    else:
        ACTS[how]()


def main() -> None:
    how = sys.argv[1]
    if "--at-start" in sys.argv:
        misbehave(how, {"id": 0})
    for line in sys.stdin:
        request = json.loads(line)
        if request["op"] == "start":
            respond(request, result=NAME)
        elif request["op"] == "stop":
            if how == "never stops":
                time.sleep(FOR_EVER)
            respond(request, result={})
            if how == "counts at the end":
                os.write(2, b"e" * 2**20)
            sys.exit(7 if how == "stops badly" else 0)
        elif how in ("never stops", "stops badly", "counts at the end"):
            respond(request, skipped="it is about the end")
        else:
            misbehave(how, request)


main()
