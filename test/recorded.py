# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recorded runs to live again, with commands of every kind; and bags changed by mcap's writer."""

from dynsim_ros.bag.run_sink import RunSink
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import MoveAnchor, PlaceBody, PushBody, SetValues, Simulator
from dynsim_ros.simulation.offline import OfflineRun
from mcap.reader import make_reader
from mcap.writer import Writer

TICK = 10_000_000  # ns, at 100 Hz
SCRIPTS = ('nothing', 'anchors', 'pushes', 'values', 'places', 'everything')


def script(name, scene, ticks):
    """Return [(time [ns], command)] of one of SCRIPTS within so many ticks of 100 Hz."""
    body = scene.bodies[0].name
    anchors = [(tick, MoveAnchor(anchor.name, (x, 0.02, 2.0)))
               for anchor in scene.anchors for tick, x in ((0, 0.01), (0.3, 0.11), (0.4, 0.12))]
    pushes = [(0, PushBody(body, (0.0, 0.1, 0.2))), (0.25, PushBody(body, (1.0, 2.0, 3.0))),
              (0.25, PushBody(body, (1.0, 0.0, 1.0), (0.01, 0.0, 0.02)
                              if hasattr(scene.bodies[0], 'orientation') else (0.0,) * 3))]
    values = [(0.1, SetValues({f'{body}.mass': 1.1, 'wrench_timeout': 0.015})),
              (0.5, SetValues({'tolerance': 1e-7, 'step': 0.002, 'rate': 200.0})),
              *((0.6, SetValues({f'{anchor.name}.velocity': (0.0, 0.1, 0.0)}))
                for anchor in scene.anchors)]
    turned = {'orientation': (0.0, 0.6, 0.0, 0.8), 'angular_velocity': (0.0, 1.0, 3.0)}
    places = [(0.35, PlaceBody(body, {'position': (0.1, 0.2, 1.1), 'velocity': (0.0, 0.3, 0.0)})),
              (0.7, PlaceBody(body, {'velocity': (0.2, 0.0, 0.0), **(
                  turned if hasattr(scene.bodies[0], 'orientation') else {})}))]
    chosen = {'nothing': [], 'anchors': anchors, 'pushes': pushes, 'values': values,
              'places': places, 'everything': anchors + pushes + values + places}[name]
    return [(round(share * ticks) * TICK, command)
            for share, command in sorted(chosen, key=lambda timed: timed[0])]


def record(path, scene='sphere_on_spring', ticks=100, commands=(), **settings):
    """Record a run of so many ticks of 100 Hz; return the Simulator at its end."""
    scene = load_scene(scene) if isinstance(scene, str) else scene
    simulator = Simulator(scene, **settings)
    simulator.prepare()
    sink = RunSink(path, simulator)
    OfflineRun(simulator, commands, sink).run(ticks * TICK * 1e-9)
    sink.close()
    return simulator


def rewritten(source, path, message=lambda topic, stamp, data: data, *, without=()):
    """
    Write a bag as mcap does, every message by what message(topic, stamp, data) returns.

    None leaves a message out; without: names of attachments and metadata to leave out.
    """
    with open(source, 'rb') as stream, open(path, 'wb') as output:
        reader, writer = make_reader(stream), Writer(output)
        writer.start(profile='ros2')
        for item in reader.iter_attachments():
            if item.name not in without:
                writer.add_attachment(item.create_time, item.log_time, item.name,
                                      item.media_type, item.data)
        for item in reader.iter_metadata():
            if item.name not in without:
                writer.add_metadata(item.name, item.metadata)
        ids = {}
        for schema, channel, recorded in reader.iter_messages(log_time_order=False):
            data = message(channel.topic, recorded.log_time, recorded.data)
            if data is None:
                continue
            if channel.topic not in ids:
                ids[channel.topic] = writer.register_channel(
                    channel.topic, channel.message_encoding, writer.register_schema(
                        schema.name, schema.encoding, schema.data), channel.metadata)
            writer.add_message(ids[channel.topic], recorded.log_time, data, recorded.log_time)
        writer.finish()
    return path


def messages(path):
    """Return {topic: {log time: data}} of a bag, as mcap reads it."""
    found = {}
    with open(path, 'rb') as stream:
        for _, channel, message in make_reader(stream).iter_messages():
            found.setdefault(channel.topic, {})[message.log_time] = message.data
    return found


def metadata(path, name='dynsim_ros'):
    """Return a metadata record of a bag, as mcap reads it."""
    with open(path, 'rb') as stream:
        return {item.name: item.metadata for item in make_reader(stream).iter_metadata()}[name]
