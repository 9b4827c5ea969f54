// Numbers as people read them.

export function bytes(n: number): string {
  const units = ['B', 'kB', 'MB', 'GB', 'TB'];
  let i = 0;
  while (n >= 1000 && i < units.length - 1) {
    n /= 1000;
    i++;
  }
  return `${i > 0 && n < 10 ? n.toFixed(1) : Math.round(n)} ${units[i]}`;
}

export function count(n: number): string {
  if (n < 1e4) return Math.round(n).toLocaleString('en');
  if (n < 1e6) return `${(n / 1e3).toFixed(n < 1e5 ? 1 : 0)} k`;
  if (n < 1e9) return `${(n / 1e6).toFixed(n < 1e8 ? 1 : 0)} M`;
  return `${(n / 1e9).toFixed(1)} G`;
}

export function seconds(s: number): string {
  if (s < 10) return `${s.toFixed(1)} s`;
  if (s < 90) return `${Math.round(s)} s`;
  return `${Math.floor(s / 60)} min ${Math.round(s % 60)} s`;
}

// To so many digits, without noughts at the end.
export const short = (x: number, digits = 4) => (Math.abs(x) >= 1e6 ? x.toExponential(Math.min(digits, 3) - 1).replace('e+', 'e') : String(Number(x.toPrecision(digits))));

// The same without an exponent, as boxes for numbers take it.
export const decimal = (x: number, digits = 4) => (isPlain(x) ? short(x, digits) : new Intl.NumberFormat('en', { useGrouping: false, maximumSignificantDigits: digits }).format(x));

// Whether a number is written without one; formats for others take long to make.
const isPlain = (x: number) => x === 0 || (Math.abs(x) > 1e-6 && Math.abs(x) < 1e6);
