"""Runs that are stopped: by a callback, an exception, Ctrl-C; and runs side by side."""

import os
import signal
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import pytest
from prototypes import NumpyStvk
from waiting import wait_until

import drape
from conftest import bits_of, command, own, run, statuses_of, with_membrane


def test_a_callback_stops_and_refines(experiment):
    stopped = run(experiment, on_iteration=lambda i: "stop")
    assert len(stopped.iterations) == 1 and not stopped.complete
    assert stopped["pcs"].levels[0].status == "cancelled"
    refined = run(experiment, on_iteration=lambda i: "refine" if i.level == 0 else None)["pcs"]
    assert statuses_of(refined) == ["refined_early_on_request", "converged"]
    assert refined.levels[0].iterations == 1


def test_callbacks_see_levels_and_iterations_and_may_keep_them(experiment):
    kept, levels = [], []
    result = run(experiment, methods=["pcs", "cascadic"], on_level=levels.append,
                 on_iteration=lambda i: kept.append((i, i.x)))
    assert [(level.method, level.level) for level in levels] == [
        ("pcs", 0), ("pcs", 1), ("cascadic", 0), ("cascadic", 1)]
    assert [level.status for level in levels[:2]] == ["converged", "converged"]
    assert levels[1].x.shape == (121, 3) and levels[1].iterations > 0
    for method in ("pcs", "cascadic"):
        states = [x.tobytes() for iteration, x in kept if iteration.method == method]
        assert len(states) == sum(level.iterations for level in levels if level.method == method)
        assert states[-1] == bits_of(result, method) and states[0] != states[1]
    assert "cascadic" in repr(kept[-1][0])


@pytest.mark.parametrize("where", ["on_iteration", "on_level"])
def test_an_exception_in_a_callback_is_raised(experiment, where, tmp_path):
    with pytest.raises(ZeroDivisionError):
        run(experiment, out=tmp_path / "r", report=False, **{where: lambda _: 1 / 0})
    command("run", "--resume", tmp_path / "r", "-q", "--no-report")
    assert bits_of(drape.read_run(tmp_path / "r")) == bits_of(run(experiment))


def test_ctrl_c_in_a_prototype_leaves_its_method_to_be_resumed(small, tmp_path):
    class Interrupted(NumpyStvk):
        due = False

        def gradient(self, x, rest):
            if Interrupted.due:
                Interrupted.due = False
                raise KeyboardInterrupt
            return super().gradient(x, rest)

    def interrupt(_):
        Interrupted.due = True

    experiment = drape.Experiment(with_membrane(small, Interrupted))
    folder, methods = tmp_path / "r", ["pcs", "newton"]
    with pytest.raises(KeyboardInterrupt):
        run(experiment, methods=methods, out=folder, report=False, on_level=interrupt)
    resumed, plain = drape.resume(folder, report=False, progress=False), run(experiment, methods=methods)
    for method in methods:
        assert resumed[method].status == plain[method].status
        assert bits_of(resumed, method) == bits_of(plain, method)


def test_a_run_is_resumed_to_the_same_bits(small, tmp_path):
    # A prototype, which the command does not know.
    experiment, folder, seen = drape.Experiment(with_membrane(small, own(NumpyStvk))), tmp_path / "r", []
    run(experiment, out=folder, report=False, on_iteration=lambda i: "stop" if i.level == 1 else None)
    assert not drape.read_run(folder).complete
    resumed = drape.resume(folder, report=False, progress=False, on_level=seen.append)
    assert resumed.complete and [level.level for level in seen] == [1]
    assert bits_of(resumed) == bits_of(run(experiment))
    again = drape.resume(folder, on_level=seen.append, progress=False)  # complete: nothing runs
    assert again.complete and len(seen) == 1
    (folder / resumed["pcs"].levels[-1].mesh).write_text("")
    with pytest.raises(RuntimeError, match="files are damaged or missing"):
        drape.resume(folder)
    with pytest.raises(RuntimeError, match="holds no run"):
        drape.resume(tmp_path)


def test_ctrl_c_raises_keyboard_interrupt(small, tmp_path):
    small["cloth"].update(columns=20, rows=20)
    small["levels"] = 3
    small["newton"] = {"force_tolerance": 1e-300, "step_size": 1e-3, "step_growth": 1, "max_steps": 10**8}
    experiment, steps = drape.Experiment(small), tmp_path / "r/iterations.csv"

    def interrupt():
        try:
            wait_until("the run makes steps", lambda: steps.exists() and steps.read_text().count("\n") > 5)
        finally:
            os.kill(os.getpid(), signal.SIGINT)

    other = threading.Thread(target=interrupt)
    other.start()
    with pytest.raises(KeyboardInterrupt):
        run(experiment, out=steps.parent, report=False)
    other.join()
    assert steps.read_text().count("\n") > 5
    experiment.check()


def test_two_runs_in_two_threads(small):
    alone = run(small, methods=["all"])
    with ThreadPoolExecutor(2) as threads:
        for result in threads.map(lambda _: run(small, methods=["all"], on_iteration=lambda i: None), range(2)):
            for method in alone.methods:
                assert bits_of(result, method) == bits_of(alone, method)


@pytest.mark.parametrize("call", ["e.run(out='r', on_iteration=lambda i: seen.set(), progress=False)",
                                  "[seen.set() for _ in e.solver('pcs')]"])
def test_the_interpreter_ends_while_a_thread_runs(small, tmp_path, call):
    small["newton"] = {"force_tolerance": 1e-300, "step_size": 1e-3, "step_growth": 1, "max_steps": 10**8}
    (tmp_path / "e.py").write_text(f"""import sys, threading, drape
e, seen = drape.Experiment({small}), threading.Event()
threading.Thread(target=lambda: {call}, daemon=True).start()
seen.wait(60)
sys.exit(5)
""")
    ended = subprocess.run([sys.executable, "e.py"], cwd=tmp_path, timeout=60, stderr=subprocess.PIPE, text=True,
                           env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)})
    assert ended.returncode == 5 and "terminate" not in ended.stderr
    if "out=" in call:
        assert drape.read_run(tmp_path / "r")["pcs"].status == "cancelled"
