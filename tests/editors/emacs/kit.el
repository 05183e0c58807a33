;;; -*- lexical-binding: t -*-
;;; What the drives of all Emacs clients share.
(package-activate-all) ; as Emacs does when it starts with a window

(setq make-backup-files nil
      auto-save-default nil
      create-lockfiles nil)

(defun robbdd-forms (page)
  "Return the forms of each block of Emacs Lisp in PAGE."
  (with-temp-buffer
    (insert-file-contents page)
    (let (blocks)
      (while (search-forward "\n```elisp\n" nil t)
        (let ((code (buffer-substring (point) (search-forward "\n```\n"))))
          (push (car (read-from-string (concat "(" (string-trim-right code "```\n") ")"))) blocks)))
      (nreverse blocks))))

(defun robbdd-configure (page client)
  "Evaluate what PAGE tells users of CLIENT to paste."
  (pcase-let ((`(,first ,second) (robbdd-forms page)))
    (mapc #'eval (if (eq client 'lsp-mode) (append (butlast first 2) second) first))))

(defconst patience 180 "Seconds that anything may take, far more than a slow machine needs.")

(defun expect (words held)
  "Say that WORDS hold; end in failure unless HELD."
  (unless held
    (message "FAILED: %s" words)
    (kill-emacs 1))
  (message "ok: %s" words))

(defmacro eventually (words &rest check)
  "Wait until CHECK holds, which WORDS say."
  (declare (indent 1))
  `(expect ,words (with-timeout (patience nil)
                    (while (not (progn ,@check))
                      (accept-process-output nil 0.05))
                    t)))

(defun before (text)
  "Go before TEXT, which is in the buffer."
  (goto-char (point-min))
  (search-forward text)
  (goto-char (match-beginning 0)))

(defun overwrite (old new)
  "Write NEW in place of the first OLD."
  (before old)
  (delete-char (length old))
  (insert new))

(defun written (text)
  "Tell whether TEXT is in the buffer."
  (save-excursion
    (goto-char (point-min))
    (search-forward text nil t)))
