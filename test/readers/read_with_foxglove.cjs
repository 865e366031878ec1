// Copyright 2026 the dynsim_ros authors
// SPDX-License-Identifier: Apache-2.0
// Prints a bag as JSON, as the readers that Foxglove publishes give it.
// Usage: node read_with_foxglove.cjs indexed|streamed FILE
const { readFileSync } = require('node:fs');
const { McapIndexedReader, McapStreamReader } = require('@mcap/core');
const { loadDecompressHandlers } = require('@mcap/support');
const { parse } = require('@foxglove/rosmsg');
const { MessageReader } = require('@foxglove/rosmsg2-serialization');

const PIECE = 10_000; // bytes that a stream gives at a time
const channels = new Map();
const readers = new Map();
const found = { messages: [], metadata: {}, attachments: {} };

// Takes a record of any kind; those that come before their schema or channel are an error.
function take(record) {
  if (record.type === 'Schema') {
    const definitions = parse(new TextDecoder().decode(record.data), { ros2: true });
    readers.set(record.id, new MessageReader(definitions));
  } else if (record.type === 'Channel') {
    channels.set(record.id, record);
  } else if (record.type === 'Message') {
    const { topic, schemaId } = channels.get(record.channelId);
    const message = readers.get(schemaId).readMessage(record.data);
    found.messages.push([topic, record.logTime, message]);
  } else if (record.type === 'Metadata') {
    found.metadata[record.name] = Object.fromEntries(record.metadata);
  } else if (record.type === 'Attachment') {
    found.attachments[record.name] = new TextDecoder().decode(record.data);
  }
}

async function readIndexed(content, decompressHandlers) {
  const readable = {
    size: async () => BigInt(content.length),
    read: async (start, length) => content.subarray(Number(start), Number(start + length)),
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  reader.schemasById.forEach(take);
  reader.channelsById.forEach(take);
  for await (const message of reader.readMessages({ validateCrcs: true })) take(message);
  for await (const metadata of reader.readMetadata()) take(metadata);
  for await (const attachment of reader.readAttachments({ validateCrcs: true })) take(attachment);
}

function readStreamed(content, decompressHandlers) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  for (let start = 0; start < content.length; start += PIECE) {
    reader.append(content.subarray(start, start + PIECE));
    for (let record = reader.nextRecord(); record; record = reader.nextRecord()) take(record);
  }
  if (!reader.done()) throw new Error('the file has no end');
}

// Whole numbers of 64 bits and arrays of one kind of number have no form of their own in JSON.
function plain(key, value) {
  if (typeof value === 'bigint') return Number(value);
  return ArrayBuffer.isView(value) ? Array.from(value) : value;
}

async function main(way, path) {
  const read = { indexed: readIndexed, streamed: readStreamed }[way];
  await read(new Uint8Array(readFileSync(path)), await loadDecompressHandlers());
  process.stdout.write(JSON.stringify(found, plain));
}

main(...process.argv.slice(2));
