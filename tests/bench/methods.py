"""The methods that the benchmark compares, one row each, and how a run of one is timed."""
import json
import os
import shlex
import subprocess
import sys
import tempfile
import threading
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path

import mitsuba_to_luxcore

HERE = Path(__file__).resolve().parent


class RunError(Exception):
    """A run failed; the message is one line."""


@cache
def _without(program, code):
    """Why a peer cannot run, or None. Asked of another process: a wrong LLVM ends the one that asks."""
    probe = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True)
    lines = probe.stderr.strip().splitlines() or [f'ended with {probe.returncode}']
    return None if probe.returncode == 0 else f'{program} does not run here: {lines[-1]}'


NO_XML = 'there is no Mitsuba file of it'


def mitsuba_needs(scene):
    return _without('Mitsuba', '''import mitsuba, drjit
mitsuba.set_variant("llvm_ad_rgb")
drjit.eval(drjit.arange(mitsuba.Float, 4) + 1)''') if scene.mitsuba else NO_XML


def luxcore_needs(scene, bidirectional=False):
    if not scene.mitsuba:
        return NO_XML
    try:
        mitsuba_to_luxcore.translate(scene.mitsuba.read_text(), scene.mitsuba.parent, bidirectional)
    except mitsuba_to_luxcore.Inexpressible as problem:
        return f'not for LuxCore: {problem}'
    return _without('LuxCore', 'import pyluxcore; pyluxcore.Init()')


@dataclass(frozen=True)
class Method:
    """command: split as a shell would, then {lsde} {python} {here} {glb} {mitsuba} {budget} {seed} {picture} {json} are
    filled in. It writes the picture as OpenEXR, or as .npy where the ending says so."""
    command: str
    picture: str = 'picture.exr'
    filters: bool = False  # understands lsde's --paths and --only
    needs: callable = lambda scene: None  # why it cannot render a scene, or None


LIMITS = '--cpu-time {budget} --no-cache --seed {seed} -o {picture} --force --quiet --json {json}'
MITSUBA = '{python} {here}/peer_mitsuba.py {mitsuba} --cpu-time {budget} --seed {seed} -o {picture} --integrator '
LUXCORE = '{python} {here}/peer_luxcore.py {mitsuba} --cpu-time {budget} --seed {seed} -o {picture} --method '

METHODS = {
    'render': Method('{lsde} render {glb} ' + LIMITS, filters=True),
    'path': Method('{lsde} reference {glb} ' + LIMITS, filters=True),
    'light': Method('{lsde} reference {glb} --integrator light ' + LIMITS, filters=True),
    'mitsuba-path': Method(MITSUBA + 'path', picture='picture.npy', needs=mitsuba_needs),
    'mitsuba-ptracer': Method(MITSUBA + 'ptracer', picture='picture.npy', needs=mitsuba_needs),
    'luxcore-photongi': Method(LUXCORE + 'photongi', picture='picture.npy', needs=luxcore_needs),
    'luxcore-bidir': Method(LUXCORE + 'bidir', picture='picture.npy',
                            needs=partial(luxcore_needs, bidirectional=True)),
}


@dataclass
class Run:
    picture: Path
    cpu: float  # seconds, user and system, as the kernel counts them
    report: dict  # what the program says of itself; empty where it says nothing


def cpu_of(command, wall_limit):
    """CPU seconds of the command, run to its end, its children included. Killed after wall_limit seconds."""
    with tempfile.TemporaryFile('w+') as log:
        child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=log)
        timer = threading.Timer(wall_limit, child.kill)
        timer.start()
        try:
            _, status, usage = os.wait4(child.pid, 0)
        except BaseException:
            child.kill()
            raise
        finally:
            timer.cancel()
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode != 0:
            log.seek(0)
            lines = log.read().strip().splitlines() or ['no message']
            raise RunError(f'exit code {child.returncode}: {lines[-1]}')
        return usage.ru_utime + usage.ru_stime


def run(method, scene, lsde, budget, seed, folder, filters=()):
    """One picture of the scene, left in the folder. budget: CPU seconds. filters: further words of the command."""
    picture, report = folder / f'{seed}.{method.picture}', folder / f'{seed}.json'
    values = dict(lsde=lsde, python=sys.executable, here=HERE, glb=scene.glb, mitsuba=scene.mitsuba, budget=budget,
                  seed=seed, picture=picture, json=report)
    command = [word.format(**values) for word in shlex.split(method.command)] + list(filters)
    cpu = cpu_of(command, wall_limit=60 + 10 * budget)  # a program that meets its budget is far from this
    if not picture.exists():
        raise RunError('it left no picture')
    return Run(picture, cpu, json.loads(report.read_text()) if report.exists() else {})
