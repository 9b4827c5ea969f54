// Lengths of the page that are needed as numbers: in CSS pixels, which grow with the size of its text.
const root = () => parseFloat(getComputedStyle(document.documentElement).fontSize);

export const rem = (count: number) => count * root();

// Of a row of the assembly, as styles.css has it.
export const rowHeight = () => rem(parseFloat(getComputedStyle(document.documentElement).getPropertyValue('--row-height')));
