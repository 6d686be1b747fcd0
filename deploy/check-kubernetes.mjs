// SPDX-License-Identifier: Apache-2.0
// Judges the objects on standard input, YAML documents, by the schemas of Kubernetes, Prometheus's
// operator and KEDA:
//
//   helm template weft helm/weft | node check-kubernetes.mjs
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {parseAllDocuments} from 'yaml';

const require = createRequire(import.meta.url);
const packages = {
  'monitoring.coreos.com': '@kubernetes-models/prometheus-operator',
  'keda.sh': '@kubernetes-models/keda',
};

let judged = 0;
for (const document of parseAllDocuments(readFileSync(0, 'utf8'))) {
  const object = document.toJS();
  const name = `${object.kind} ${object.metadata.name}`;
  const home = packages[object.apiVersion.split('/')[0]] ?? 'kubernetes-models';
  const Model = require(`${home}/${object.apiVersion}/${object.kind}`)[object.kind];
  try {
    new Model(object).validate();
    ++judged;
  } catch (error) {
    console.error(`${name}: ${error.message}`);
    process.exitCode = 1;
  }
}
if (judged === 0) {
  console.error('no object');
  process.exitCode = 1;
}
console.log(`${judged} objects`);
