// SPDX-License-Identifier: Apache-2.0
// Values of a size expression, for the heat map alone: what is right and what is wrong is the
// server's to say. The grammar is that of docs/size.md, without slope().
//
//   const value = compile("0.1 + 0.2*distance", ["distance"]);
//   value?.(x, y, [distance]);
//
// Undefined if the text is not such an expression.

export type Value = (x: number, y: number, fields: readonly number[]) => number;

const functions: Record<string, { least: number; most: number; of: (...values: number[]) => number }> = {
  sqrt: { least: 1, most: 1, of: Math.sqrt },
  abs: { least: 1, most: 1, of: Math.abs },
  exp: { least: 1, most: 1, of: Math.exp },
  log: { least: 1, most: 1, of: Math.log },
  sin: { least: 1, most: 1, of: Math.sin },
  cos: { least: 1, most: 1, of: Math.cos },
  tan: { least: 1, most: 1, of: Math.tan },
  floor: { least: 1, most: 1, of: Math.floor },
  ceil: { least: 1, most: 1, of: Math.ceil },
  defined: { least: 1, most: 1, of: (value) => Number(!Number.isNaN(value)) },
  atan2: { least: 2, most: 2, of: Math.atan2 },
  pow: { least: 2, most: 2, of: Math.pow },
  hypot: { least: 2, most: 2, of: Math.hypot },
  clamp: { least: 3, most: 3, of: (value, low, high) => Math.min(Math.max(value, low), high) },
  min: { least: 2, most: Infinity, of: Math.min },
  max: { least: 2, most: Infinity, of: Math.max },
  coalesce: { least: 2, most: Infinity, of: (...values) => values.find((value) => !Number.isNaN(value)) ?? NaN },
};

// Loosest first.
const binary: Record<string, (a: number, b: number) => number>[] = [
  { "||": (a, b) => Number(a !== 0 || b !== 0) },
  { "&&": (a, b) => Number(a !== 0 && b !== 0) },
  {
    "<=": (a, b) => Number(a <= b),
    ">=": (a, b) => Number(a >= b),
    "==": (a, b) => Number(a === b),
    "!=": (a, b) => Number(a !== b),
    "<": (a, b) => Number(a < b),
    ">": (a, b) => Number(a > b),
  },
  { "+": (a, b) => a + b, "-": (a, b) => a - b },
  { "*": (a, b) => a * b, "/": (a, b) => a / b },
];

const deepest = 256;

class Malformed extends Error {}

export function compile(text: string, fields: readonly string[]): Value | undefined {
  try {
    return new Parser(text, fields).all();
  } catch (error) {
    if (error instanceof Malformed) return undefined;
    throw error;
  }
}

class Parser {
  private readonly tokens: string[];
  private at = 0;
  private depth = 0;

  constructor(text: string, private readonly fields: readonly string[]) {
    const known = /\s*((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|[A-Za-z_]\w*|\|\||&&|[<>=!]=|[-+*/^<>!?:(),])/y;
    this.tokens = [];
    for (const end = text.trimEnd().length; known.lastIndex < end; ) {
      const found = known.exec(text);
      if (!found) throw new Malformed();
      this.tokens.push(found[1]);
    }
  }

  all(): Value {
    const value = this.choice();
    if (this.at < this.tokens.length) throw new Malformed();
    return value;
  }

  private choice(): Value {
    if (++this.depth > deepest) throw new Malformed();
    const condition = this.chain(0);
    let value = condition;
    if (this.take("?")) {
      const yes = this.choice();
      this.expect(":");
      const no = this.choice();
      value = (x, y, f) => (condition(x, y, f) !== 0 ? yes(x, y, f) : no(x, y, f));
    }
    --this.depth;
    return value;
  }

  private chain(level: number): Value {
    if (level === binary.length) return this.sign();
    let left = this.chain(level + 1);
    for (;;) {
      const operator = binary[level][this.tokens[this.at]];
      if (!operator) return left;
      ++this.at;
      const [a, b] = [left, this.chain(level + 1)];
      left = (x, y, f) => operator(a(x, y, f), b(x, y, f));
    }
  }

  // -x^2 is -(x^2), and 2^-1 is 0.5.
  private sign(): Value {
    if (++this.depth > deepest) throw new Malformed();
    let value: Value;
    if (this.take("-")) {
      const of = this.sign();
      value = (x, y, f) => -of(x, y, f);
    } else if (this.take("+")) {
      value = this.sign();
    } else if (this.take("!")) {
      const of = this.sign();
      value = (x, y, f) => Number(of(x, y, f) === 0);
    } else {
      value = this.power();
    }
    --this.depth;
    return value;
  }

  private power(): Value {
    const base = this.operand();
    if (!this.take("^")) return base;
    const exponent = this.sign();
    return (x, y, f) => base(x, y, f) ** exponent(x, y, f);
  }

  private operand(): Value {
    const token = this.tokens[this.at++] ?? "";
    if (/^[\d.]/.test(token)) {
      const number = Number(token);
      return () => number;
    }
    if (token === "(") {
      const value = this.choice();
      this.expect(")");
      return value;
    }
    if (token === "x") return (x) => x;
    if (token === "y") return (_, y) => y;
    if (token === "pi") return () => Math.PI;
    if (token === "e") return () => Math.E;
    const field = this.fields.indexOf(token);
    if (field >= 0) return (_x, _y, f) => f[field];
    if (!Object.hasOwn(functions, token)) throw new Malformed();
    return this.call(functions[token]);
  }

  private call({ least, most, of }: (typeof functions)[string]): Value {
    this.expect("(");
    const given: Value[] = [];
    do given.push(this.choice());
    while (this.take(","));
    this.expect(")");
    if (given.length < least || given.length > most) throw new Malformed();
    return (x, y, f) => of(...given.map((value) => value(x, y, f)));
  }

  private take(token: string): boolean {
    if (this.tokens[this.at] !== token) return false;
    ++this.at;
    return true;
  }

  private expect(token: string): void {
    if (!this.take(token)) throw new Malformed();
  }
}
