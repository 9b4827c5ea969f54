// The view's place on the page.
import { useEffect, useRef } from 'react';
import { setStage } from './current_stage';
import { Stage } from './stage';

export function Viewport() {
  const element = useRef<HTMLDivElement>(null);
  const cube = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (!element.current || !cube.current) return;
    const stage = new Stage(element.current, cube.current);
    setStage(stage);
    return () => {
      setStage(null);
      stage.dispose();
    };
  }, []);
  return (
    <>
      <div ref={element} className="stage" tabIndex={0} role="application" aria-label="Picture of the model: arrow keys turn the view, plus and minus zoom, F fits" data-testid="stage" />
      <div ref={cube} className="cube-place" aria-hidden />
    </>
  );
}
