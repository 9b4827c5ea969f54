// Models that were opened in this browser, newest first.
const key = 'crescente.recent';
const most = 8;

export type RecentFile = { file: string; name: string };

export function recentFiles(): RecentFile[] {
  try {
    const list: unknown = JSON.parse(localStorage.getItem(key) ?? '[]');
    return Array.isArray(list) ? (list as RecentFile[]).filter((one) => typeof one?.file === 'string' && typeof one.name === 'string') : [];
  } catch {
    return [];
  }
}

export function rememberFile(file: string, name: string): void {
  const list = [{ file, name }, ...recentFiles().filter((one) => one.file !== file)].slice(0, most);
  localStorage.setItem(key, JSON.stringify(list));
}
