// SPDX-License-Identifier: Apache-2.0
// Judges a software bill of materials by the schema of CycloneDX:
//
//   node check-bill.mjs weft.cdx.json
import {readFileSync} from 'node:fs';
import {Spec, Validation} from '@cyclonedx/cyclonedx-library';

const bill = readFileSync(process.argv[2], 'utf8');
const fault = await new Validation.JsonStrictValidator(Spec.Version.v1dot6).validate(bill);
if (fault !== null) {
  console.error(JSON.stringify(fault, null, 1));
  process.exitCode = 1;
}
