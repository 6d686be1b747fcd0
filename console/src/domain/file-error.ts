// SPDX-License-Identifier: Apache-2.0
// A file is not what it should be. The message names the place first: "line 7: ...".
export class FileError extends Error {
  constructor(place: string, what: string) {
    super(place ? `${place}: ${what}` : what);
  }
}
