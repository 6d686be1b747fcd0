// SPDX-License-Identifier: Apache-2.0
// Meshes a plate with a hole, finer towards the hole, and prints what came:
//
//   npm ci
//   node mesh.mjs [ANGLE]
//
// ANGLE is the minimum angle in degrees. The server is WEFT_SERVER, by default 127.0.0.1:7421;
// WEFT_TOKEN its token, WEFT_TLS_CA the certificates by which to trust it: without them the
// connection is not encrypted.
import {createHash} from 'node:crypto';
import {readFileSync} from 'node:fs';
import {fileURLToPath} from 'node:url';
import grpc from '@grpc/grpc-js';
import protoLoader from '@grpc/proto-loader';
import protobuf from 'protobufjs';

const proto = fileURLToPath(new URL('../../../proto', import.meta.url));
// With keepCase fields are named as in the .proto files; other names would be left out in silence.
const options = {
  keepCase: true,
  longs: Number,
  enums: String,
  defaults: true,
  oneofs: true,
  includeDirs: [proto],
};
const {weft} = grpc.loadPackageDefinition(
    protoLoader.loadSync('weft/v1/mesh_service.proto', options));

// The details of an error: a google.rpc.Status in the trailer grpc-status-details-bin.
const errors = new protobuf.Root();
errors.resolvePath = (_, target) => `${proto}/${target}`;
errors.loadSync(['google/rpc/status.proto', 'google/rpc/error_details.proto']);

function detailsOf(error) {
  const [bytes] = error.metadata?.get('grpc-status-details-bin') ?? [];
  if (!bytes) return [];
  return errors.lookupType('google.rpc.Status').decode(bytes).details.map(({type_url, value}) => {
    const type = errors.lookupType(type_url.split('/').pop());
    return {type: type.name, ...type.toObject(type.decode(value), {defaults: true})};
  });
}

function domain() {
  const plate = [0, 0, 10, 0, 10, 6, 0, 6];
  const hole = [];
  for (let i = 0; i < 24; ++i) {
    const angle = i * Math.PI / 12;
    hole.push(3 + Math.cos(angle), 3 + Math.sin(angle));
  }
  const ring = (first, count) =>
      Array.from({length: count}, (_, i) => [first + i, first + (i + 1) % count]).flat();
  return {
    points: [...plate, ...hole],
    segments: [...ring(0, 4), ...ring(4, 24)],
    segment_markers: [...Array(4).fill(1), ...Array(24).fill(2)],
    holes: [3, 3],  // a seed in the face to carve away
  };
}

// Takes the chunks of a mesh in their order. Vertices are numbered across all of them.
class Mesh {
  points = [];
  triangles = [];
  chunks = 0;
  digest = createHash('sha256');

  add(chunk) {
    if (chunk.index !== this.chunks++) throw new Error(`chunk ${chunk.index} is out of order`);
    for (const each of chunk.coordinates) this.points.push(each);
    for (const each of chunk.triangles) this.triangles.push(each);
    this.digest.update(chunk.sha256);
  }

  // A stream without a summary is not a mesh, nor is one whose chunks are not those of the summary.
  check(summary) {
    if (!summary) throw new Error('the stream ended without a summary');
    if (this.digest.digest('hex') !== summary.sha256.toString('hex'))
      throw new Error('the mesh is damaged');
  }
}

async function generate(client, metadata, request) {
  const mesh = new Mesh();
  let summary;
  // Ends the work, too, if it takes longer.
  const deadline = Date.now() + 60_000;
  for await (const response of client.GenerateMesh(request, metadata, {deadline})) {
    if (response.message === 'chunk') mesh.add(response.chunk);
    if (response.message === 'summary') summary = response.summary;
  }
  mesh.check(summary);
  return {mesh, summary};
}

const {WEFT_SERVER, WEFT_TOKEN, WEFT_TLS_CA} = process.env;
const credentials = WEFT_TLS_CA ?
    grpc.credentials.createSsl(readFileSync(WEFT_TLS_CA)) :
    grpc.credentials.createInsecure();
const metadata = new grpc.Metadata();
if (WEFT_TOKEN) metadata.set('authorization', `Bearer ${WEFT_TOKEN}`);

const client = new weft.v1.MeshService(WEFT_SERVER ?? '127.0.0.1:7421', credentials);
try {
  const {mesh, summary} = await generate(client, metadata, {
    domain: domain(),
    size: {expression: '0.05 + 0.1*(hypot(x - 3, y - 3) - 1)', measure: 'MEASURE_EDGE'},
    quality: {min_angle_deg: Number(process.argv[2] ?? 25)},
  });
  console.log(`${mesh.triangles.length / 3} triangles, ${mesh.points.length / 2} vertices in ` +
      `${mesh.chunks} chunks, angles ${summary.min_angle_deg.toFixed(2)} to ` +
      `${summary.max_angle_deg.toFixed(2)} degrees, area ${summary.area.toFixed(4)}`);
} catch (error) {
  if (!(error.code in grpc.status)) throw error;
  console.error(`${grpc.status[error.code]}: ${error.details}`);
  for (const detail of detailsOf(error)) {
    if (detail.type === 'ErrorInfo') console.error(`  reason ${detail.reason}`);
    if (detail.type === 'BadRequest')
      for (const {field} of detail.fieldViolations) console.error(`  field ${field}`);
    if (detail.type === 'RetryInfo')
      console.error(`  the same request may succeed in ${detail.retryDelay.seconds} s`);
  }
  process.exitCode = 1;
} finally {
  client.close();
}
