# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The node for a long time: at 1 kHz, with two subscribers and 100 commands a second.

Usage: python benchmarks/soak.py [--duration SECONDS] [--depth MESSAGES]; a line every 10 s, and
exit status 1 if a message was lost, a tick was missed or memory grew. A message is lost if the
publisher wrote it and a reliable subscriber, which takes what comes every few milliseconds, did
not get it; the stamps of a topic must follow each other by a tick.
"""

import argparse
import sys
import time

from node_processes import keep_to_this_machine, listening, running, TOPICS

RATE, COMMANDS = 1000, 100
# What the start leaves to be allocated is allocated by then [s]; the least that is growth [bytes].
SETTLED, GROWTH = 30.0, 2_000_000


def soak(duration, depth, report=print):
    """Run for some seconds; return what went wrong, as lines."""
    mark = keep_to_this_machine()
    wrong, memories = [], []
    histories = {f'qos_overrides./dynsim/{topic}.publisher.depth': depth for topic in TOPICS}
    with running('ours', RATE, **histories) as node, \
            listening(node) as first, listening(node) as second:
        time.sleep(1.0)
        start = time.monotonic()
        while (left := start + duration - time.monotonic()) > 0.0:
            seconds = min(max(left, 1.0), 10.0)
            first.begin(seconds, RATE, COMMANDS)
            second.begin(seconds, RATE)
            heard = [first.end(), second.end()]
            elapsed = time.monotonic() - start
            if elapsed > min(SETTLED, 0.3 * duration):
                memories.append(node.memory())
            wrong += faults(heard, elapsed)
            report(line(heard, node, elapsed))
    mark.close()
    if memories and memories[-1] - memories[0] > GROWTH:
        wrong.append(f'memory grew from {memories[0]} to {memories[-1]} bytes')
    return wrong


def faults(heard, elapsed):
    """Return what is wrong with what both subscribers heard."""
    return [f'{elapsed:.0f} s: subscriber {number}, {topic}: {counts["lost"]} lost, '
            f'{counts["gaps"]} gaps between stamps, {counts["missed"]} ticks missed, of '
            f'{counts["sent"]}'
            for number, each in enumerate(heard, 1) for topic, counts in each['topics'].items()
            if counts['lost'] or counts['gaps'] or counts['missed']]


def line(heard, node, elapsed):
    latency, sending = heard[0]['latency'], heard[0]['sending']
    total = sum(counts['received'] for each in heard for counts in each['topics'].values())
    return (f'{elapsed:5.0f} s  {total} messages  memory {node.memory() / 1e6:.1f} MB  '
            f'interval off by p99 {sending["p99"]:.0f} us, max {sending["max"]:.0f} us  '
            f'command to state p50 {latency["p50"]:.0f} us, p99 {latency["p99"]:.0f} us')


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('--duration', type=float, default=600.0, help='seconds (default 600)')
    parser.add_argument('--depth', type=int, default=10,
                        help="what each publisher keeps for repairs (default: the node's own, 10)")
    options = parser.parse_args()
    wrong = soak(options.duration, options.depth, lambda text: print(text, flush=True))
    print('\n'.join(wrong) or 'no message lost, no tick missing, memory flat')
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
