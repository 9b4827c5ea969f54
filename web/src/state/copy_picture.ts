// The picture as it is now, into the clipboard.
import { theStage } from '../view/current_stage';
import { tell, warn } from './notices';

export async function copyPicture(): Promise<void> {
  const canvas = theStage()?.picture.canvas;
  if (!canvas) return;
  try {
    const blob = new Promise<Blob>((resolve, reject) => canvas.toBlob((made) => (made ? resolve(made) : reject(new Error('the picture could not be encoded'))), 'image/png'));
    await navigator.clipboard.write([new ClipboardItem({ 'image/png': blob })]);
    tell('The picture is in the clipboard');
  } catch (error) {
    warn('The picture could not be copied', error instanceof Error ? error.message : String(error));
  }
}
