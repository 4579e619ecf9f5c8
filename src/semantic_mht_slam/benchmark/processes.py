"""Child processes, of which none outlives the benchmark."""
from __future__ import annotations

import subprocess
import threading
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from typing import Callable, Iterator, Sequence, TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")


class Interrupted(Exception):
    """A process was asked for after the benchmark was told to stop."""


class Processes:
    """Starts programs from several threads; `stop` ends those that run and refuses further ones."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._running: set[subprocess.Popen] = set()
        self._is_stopped = False

    def run(self, command: Sequence[str], **how) -> subprocess.CompletedProcess:
        """As subprocess.run without standard input. Raises Interrupted after `stop`, OSError if it cannot start."""
        with self._lock:
            if self._is_stopped:
                raise Interrupted
            process = subprocess.Popen(command, stdin=subprocess.DEVNULL, **how)
            self._running.add(process)
        try:
            output, errors = process.communicate()
        finally:
            with self._lock:
                self._running.discard(process)
        return subprocess.CompletedProcess(command, process.returncode, output, errors)

    def stop(self) -> None:
        with self._lock:
            self._is_stopped = True
            for process in self._running:
                process.terminate()

    def each(self, function: Callable[[Item], Result], items: Sequence[Item],
             at_once: int) -> Iterator[tuple[int, Result]]:
        """Calls the function for each item, at most `at_once` at a time; yields the place of an item and its result as
        it ends. An exception, an interrupt among them, stops the processes and goes on when they have ended.
        """
        pool = ThreadPoolExecutor(max_workers=at_once)
        places: dict[Future, int] = {}
        try:
            for i, item in enumerate(items):
                places[pool.submit(function, item)] = i
            for future in as_completed(places):
                yield places[future], future.result()
        except BaseException:
            for future in places:
                future.cancel()
            self.stop()
            raise
        finally:
            pool.shutdown()
