// Pictures and scenes that the program makes for downloading, with their progress.
import { connection, send } from './session';
import { complain } from './notices';
import { Refused } from '../protocol/socket';
import type { ExportRequest } from '../protocol/messages';
import { get, set, type ExportItem } from './store';

let nextKey = -1; // of items that have no number of the program yet

const change = (key: number, news: Partial<ExportItem>) => set({ exports: get().exports.map((item) => (item.key === key ? { ...item, ...news } : item)) });

// download: fetched as soon as it is there, rather than when the user asks.
export async function startExport(request: ExportRequest, title: string, download: boolean): Promise<void> {
  const key = nextKey--;
  set({ exports: [...get().exports, { key, title, fraction: 0 }] });
  try {
    const answer = await connection.request(
      { export: request.format === 'json' ? { format: 'json' } : request },
      (news) => news.exporting && change(key, news.exporting),
    );
    if (!answer.exported) return;
    change(key, { ...answer.exported, fraction: 1 });
    if (download) fetchFile(answer.exported.address, answer.exported.name);
  } catch (error) {
    if (error instanceof Refused) complain(error.failure);
    change(key, { problem: error instanceof Error ? error.message : String(error) });
  }
}

export function cancelExport(item: ExportItem): void {
  if (item.number !== undefined && item.fraction < 1 && !item.problem) send({ cancel: item.number });
  set({ exports: get().exports.filter((one) => one.key !== item.key) });
}

export function fetchFile(address: string, name: string): void {
  const link = document.createElement('a');
  link.href = address;
  link.download = name;
  link.click();
}
